# Compiles each header under include_dir on its own, without code; by the compiler cache where the build has one. zwidth.hpp
# has all of them.
list(TRANSFORM system_dirs PREPEND -isystem)
file(GLOB_RECURSE headers RELATIVE ${include_dir} ${include_dir}/*.hpp)
file(READ ${include_dir}/zwidth/zwidth.hpp all_of_them)
foreach(header ${headers})
  string(FIND "${all_of_them}" "#include \"${header}\"" at)
  if(at EQUAL -1 AND NOT header STREQUAL zwidth/zwidth.hpp)
    message(SEND_ERROR "zwidth.hpp lacks ${header}")
  endif()
  execute_process(COMMAND ${launcher} ${compiler} -std=c++20 -O0 -I${include_dir} ${system_dirs} -x c++ -c ${include_dir}/${header} -o ${object}
    RESULT_VARIABLE result ERROR_VARIABLE error)
  if(NOT result EQUAL 0)
    message(SEND_ERROR "${header} does not compile alone:\n${error}")
  endif()
endforeach()
list(LENGTH headers count)
message("${count} headers")
