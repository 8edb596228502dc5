# Warnings of our own code; never exported to users of the library.
add_library(zwidth_warnings_flags INTERFACE)
target_compile_options(zwidth_warnings_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion
  -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual -Wdouble-promotion)
# BUILD_INTERFACE keeps the flags out of the installed export.
add_library(zwidth_warnings INTERFACE)
target_link_libraries(zwidth_warnings INTERFACE $<BUILD_INTERFACE:zwidth_warnings_flags>)
