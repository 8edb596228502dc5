# zwidth_unity(TARGET SOURCE...): compiles those files of a room, or of its tests, together whose first letters are near
# each other, so that a new file moves no other one. Names in anonymous namespaces must be distinct within a group: the
# compiler says so, and what follows is compiled alone.
function(zwidth_unity target)
  # Long by themselves and with little in common: alone, they spread over the cores.
  set(alone plant_sensitivity identifiability pole_count_in_digits grasp_discs loop_crossovers matrix_products random_mechanism
    point_region_test)
  list(APPEND alone wall_recommendation mat5_matrix welch)  # some names of theirs are others in wall_search, mat_recording
  # What the program loads on demand. The kernel includes itself besides, once per instruction set.
  list(APPEND alone stiffness_kernel mat73_file least_squares quiet_solve exact_sampling transfer_function mujoco_file mechanism_text)
  set(exact exact_fraction exact_modal_form exact_partial_fractions exact_poles)  # together, for the same reason
  # tests that name their seed, cases or period as their neighbours do
  list(APPEND alone absolute_stability_zero_test critical_stiffness_property_test critical_stiffness_test crowded_poles_property_test
    diagnosis_property_test drive_gains_test export_test hybrid_loop_linear_test hybrid_loop_property_test
    inverse_dynamics_test
    pooled_response_test relay_trials_test tracking_test same_answer_on_recordings_test simulate_test study_test
    time_axis_test uff_recording_test velocity_filter_test wall_filter_file_test)
  foreach(source IN LISTS ARGN)
    cmake_path(GET source STEM name)
    if(name IN_LIST exact)
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP exact)
    endif()
    if(NOT name IN_LIST alone AND source MATCHES "/src/identification/([a-z_]+)/")
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP identification_${CMAKE_MATCH_1})
      continue()
    endif()
    foreach(letters a-d e-l m-r s-z)
      if(NOT name IN_LIST alone AND NOT name IN_LIST exact AND source MATCHES "/(src|tests)/([a-z]+)/([a-z_]+/)*[${letters}][^/]*$")
        set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${CMAKE_MATCH_2}_${letters})
      endif()
    endforeach()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
