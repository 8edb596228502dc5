# cmake -D PROGRAM=zwidth -D FOLDER=... -P zwidth_generate.cmake: the program's manual pages and completions, as it prints
# them itself.
function(generate kind file)
  execute_process(COMMAND ${PROGRAM} --generate ${kind} OUTPUT_FILE ${FOLDER}/${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER}/man1 ${FOLDER}/bash ${FOLDER}/zsh ${FOLDER}/fish)
generate(bash bash/zwidth)
generate(zsh zsh/_zwidth)
generate(fish fish/zwidth.fish)
generate(man man1/zwidth.1)
# The pages of the commands are those that the program's own names: man-COMMAND.
file(READ ${FOLDER}/bash/zwidth completion)
string(REGEX MATCH "--generate\\) words='([^']*)'" found "${completion}")
string(REGEX MATCHALL "man-[a-z]+" pages "${CMAKE_MATCH_1}")
foreach(page IN LISTS pages)
  string(REPLACE "man-" "zwidth-" name ${page})
  generate(${page} man1/${name}.1)
endforeach()
