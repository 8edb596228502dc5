include(CMakePackageConfigHelpers)
install(TARGETS zwidth zwidth_core EXPORT zwidth_targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY include/zwidth DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT zwidth_targets NAMESPACE zwidth:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/zwidth)
configure_package_config_file(cmake/zwidth-config.cmake.in ${PROJECT_BINARY_DIR}/zwidth-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/zwidth)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/zwidth-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/zwidth-config.cmake ${PROJECT_BINARY_DIR}/zwidth-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/zwidth)
if(BUILD_SHARED_LIBS)  # what a static library needs beside itself not all has a file of pkg-config's
  file(RELATIVE_PATH zwidth_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  configure_file(cmake/zwidth.pc.in zwidth.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/zwidth.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endif()
