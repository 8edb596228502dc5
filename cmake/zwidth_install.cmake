include(CMakePackageConfigHelpers)
install(TARGETS zwidth EXPORT zwidth_targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY include/zwidth DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT zwidth_targets NAMESPACE zwidth:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/zwidth)
configure_package_config_file(cmake/zwidth-config.cmake.in ${PROJECT_BINARY_DIR}/zwidth-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/zwidth)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/zwidth-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/zwidth-config.cmake ${PROJECT_BINARY_DIR}/zwidth-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/zwidth)
