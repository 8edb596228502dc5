# zwidth_unity(TARGET SOURCE...): compiles those files of a room together whose first letters are near each other, so that
# a new file moves no other one. Names in anonymous namespaces must be distinct within a group: the compiler says so.
function(zwidth_unity target)
  # Long by themselves and with little in common: alone, they spread over the cores.
  set(alone plant_slopes identifiability pole_count_in_digits)
  list(APPEND alone wall_recommendation mat5_matrix)  # some names of theirs are others in wall_search, mat73_file
  list(APPEND alone stiffness_kernel)  # includes itself, once per instruction set
  foreach(source IN LISTS ARGN)
    cmake_path(GET source STEM name)
    foreach(letters a-d e-l m-r s-z)
      if(NOT name IN_LIST alone AND source MATCHES "/src/([a-z]+)/[${letters}][^/]*$")
        set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${CMAKE_MATCH_1}_${letters})
      endif()
    endforeach()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
