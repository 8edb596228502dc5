# zwidth::core: the part of the library that needs no file, fit, simulation or mechanism (include/zwidth/core.hpp). Of the static
# library it is an archive of the same object files, whose programs load few shared libraries; of the shared one another name.
if(BUILD_SHARED_LIBS)
  add_library(zwidth_core INTERFACE)
  target_link_libraries(zwidth_core INTERFACE zwidth)
else()
  set(beyond_core "identification|io|mechanism|rig|simulation|study|workspace")
  add_library(zwidth_core STATIC "$<FILTER:$<TARGET_OBJECTS:zwidth>,EXCLUDE,zwidth.dir/(src/|Unity/unity_)(${beyond_core})[/_]>")
  set_target_properties(zwidth_core PROPERTIES LINKER_LANGUAGE CXX)
  target_compile_features(zwidth_core INTERFACE cxx_std_20)
  target_include_directories(zwidth_core INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(zwidth_core INTERFACE Eigen3::Eigen tl::expected $<LINK_ONLY:fmt::fmt> $<LINK_ONLY:TBB::tbb>
    $<LINK_ONLY:${ZWIDTH_HWY_LIBRARY}> $<LINK_ONLY:${ZWIDTH_ARB_LIBRARY}> $<LINK_ONLY:${ZWIDTH_FLINT_LIBRARY}>
    $<LINK_ONLY:${ZWIDTH_GMP_LIBRARY}>)
endif()
set_target_properties(zwidth_core PROPERTIES EXPORT_NAME core)
add_library(zwidth::core ALIAS zwidth_core)
