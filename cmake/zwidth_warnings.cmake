# Warnings of our own code. Link it as $<BUILD_INTERFACE:zwidth_warnings> where the target is exported: the flags are
# never forced on users of the library.
add_library(zwidth_warnings INTERFACE)
target_compile_options(zwidth_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion
  -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual -Wdouble-promotion)
# GCC 12 sees overlapping copies inside its own std::string (GCC bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(zwidth_warnings INTERFACE -Wno-restrict)
endif()
