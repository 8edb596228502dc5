# The library as a shared one: its soname, and the public names as the only ones that it exports. Tests reach what is not
# public too, and are built with the static library.
if(ZWIDTH_BUILD_TESTS)
  message(FATAL_ERROR "the tests need names that the shared library hides: BUILD_SHARED_LIBS=ON with ZWIDTH_BUILD_TESTS=OFF")
endif()
# A minor version may change what programs are linked with; zwidth-config-version.cmake says the same.
set(exports ${PROJECT_SOURCE_DIR}/cmake/zwidth_exports.map)
set_target_properties(zwidth PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
  CXX_VISIBILITY_PRESET default LINK_DEPENDS ${exports})
target_compile_options(zwidth PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fno-semantic-interposition>)
target_link_options(zwidth PRIVATE LINKER:--version-script=${exports} LINKER:--no-undefined LINKER:--as-needed)
# Its users need none of these: they are kept out of what is exported to them.
set(zwidth_uses "$<BUILD_INTERFACE:${zwidth_uses}>")
