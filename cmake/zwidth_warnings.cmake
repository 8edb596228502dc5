# Warnings of our own code. Link it as $<BUILD_INTERFACE:zwidth_warnings> where the target is exported: the flags are
# never forced on users of the library.
add_library(zwidth_warnings INTERFACE)
target_compile_options(zwidth_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion
  -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual -Wdouble-promotion)
# GCC 12 sees overlapping copies inside its own std::string (GCC bug 105651). What it says of bounds depends on how far it
# inlined and is wrong of strings in moved aggregates too: shown, never an error; the sanitizers find the true ones.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(zwidth_warnings INTERFACE -Wno-restrict -Wno-error=array-bounds -Wno-error=stringop-overflow
    -Wno-error=maybe-uninitialized)
endif()
# In a group of sources (zwidth_unity) these compare files that meet by chance. They hold where each is compiled alone.
set(grouped $<STREQUAL:$<TARGET_PROPERTY:UNITY_BUILD_MODE>,GROUP>)
target_compile_options(zwidth_warnings INTERFACE $<${grouped}:-Wno-shadow>
  $<$<AND:${grouped},$<CXX_COMPILER_ID:GNU>>:-Wno-subobject-linkage>)
