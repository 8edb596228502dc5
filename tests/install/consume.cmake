# Installs the build, takes the C++ example from README.md and the CMake project from docs/install.md, builds them against the installed copy and
# runs the program from the project's root.
file(REMOVE_RECURSE ${work_dir}/prefix ${work_dir}/consumer)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif()
endfunction()

# The text of the only fenced block of a document in that language.
function(block_of document language variable)
  file(READ ${source_dir}/${document} text)
  if(NOT text MATCHES "\n```${language}\n([^`]*)\n```")
    message(FATAL_ERROR "${document} has no ${language} example")
  endif()
  set(${variable} "${CMAKE_MATCH_1}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${build_dir} --prefix ${work_dir}/prefix)
block_of(README.md cpp example)
block_of(docs/install.md cmake project)
file(WRITE ${work_dir}/consumer/main.cpp "${example}\n")
file(WRITE ${work_dir}/consumer/CMakeLists.txt "${project}\n")
set(settings -G ${generator} -D CMAKE_PREFIX_PATH=${work_dir}/prefix -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_CXX_FLAGS=${flags}
  -D CMAKE_BUILD_TYPE=${type} -D "CMAKE_CXX_FLAGS_RELEASE=-O0 -DNDEBUG")  # the library is optimised: these are quicker to compile
run(${CMAKE_COMMAND} -S ${work_dir}/consumer -B ${work_dir}/consumer/build ${settings})
run(${CMAKE_COMMAND} --build ${work_dir}/consumer/build)

execute_process(COMMAND ${work_dir}/consumer/build/wall WORKING_DIRECTORY ${source_dir}
  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE error)
if(NOT result EQUAL 0 OR NOT output MATCHES "8848\\.7")
  message(FATAL_ERROR "README's example answered (${result}):\n${output}${error}")
endif()

# The C++ examples, as a project of their own.
run(${CMAKE_COMMAND} -S ${source_dir}/examples/cmake -B ${work_dir}/examples ${settings})
run(${CMAKE_COMMAND} --build ${work_dir}/examples)
function(run_example expected)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${source_dir} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE error)
  if(NOT result EQUAL 0 OR NOT output MATCHES "${expected}")
    message(FATAL_ERROR "${ARGN} answered (${result}):\n${output}${error}")
  endif()
endfunction()
run_example("5776\\.09" ${work_dir}/examples/analyse devices/lhifam.toml)
run_example("after 2 s" ${work_dir}/examples/control_loop)
run_example("least limit of 1000 cables" ${work_dir}/examples/many_devices devices/lhifam.toml)

# zwidth::core, in a project that knows nothing else: few shared libraries beside those of C and C++.
file(WRITE ${work_dir}/core/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)\nproject(core LANGUAGES CXX)\n"
  "find_package(zwidth REQUIRED COMPONENTS core)\nadd_executable(knob ${source_dir}/examples/cpp/device_in_code.cpp)\n"
  "target_link_libraries(knob PRIVATE zwidth::core)\n")
run(${CMAKE_COMMAND} -S ${work_dir}/core -B ${work_dir}/core/build ${settings})
run(${CMAKE_COMMAND} --build ${work_dir}/core/build)
run_example("wall to render: K = " ${work_dir}/core/build/knob)
execute_process(COMMAND ldd ${work_dir}/core/build/knob OUTPUT_VARIABLE loaded COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "lib[a-z+_-]+[0-9.-]*\\.so" loaded "${loaded}")
list(FILTER loaded EXCLUDE REGEX "lib(c|m|stdc\\+\\+|gcc_s|pthread)\\.so")
list(REMOVE_DUPLICATES loaded)
list(LENGTH loaded count)
if(count GREATER 9 AND NOT flags MATCHES sanitize)
  message(FATAL_ERROR "a program of zwidth::core loads ${loaded}")
endif()

# The C++ snippet of docs/examples.md.
file(READ ${source_dir}/docs/examples.md page)
if(NOT page MATCHES "\n```cpp\n([^`]*)\n```")
  message(FATAL_ERROR "docs/examples.md has no C++ example")
endif()
file(WRITE ${work_dir}/consumer/main.cpp "${CMAKE_MATCH_1}\n")
run(${CMAKE_COMMAND} --build ${work_dir}/consumer/build)
run_example("N/m" ${work_dir}/consumer/build/wall)

# Beside the program: its manual pages and completions.
foreach(file man/man1/zwidth.1 man/man1/zwidth-analyze.1 bash-completion/completions/zwidth zsh/site-functions/_zwidth
    fish/vendor_completions.d/zwidth.fish)
  if(EXISTS ${work_dir}/prefix/bin/zwidth AND NOT EXISTS ${work_dir}/prefix/share/${file})
    message(FATAL_ERROR "share/${file} is not installed")
  endif()
endforeach()
