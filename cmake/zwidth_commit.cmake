# Script, run by every build: writes OUTPUT with the commit of SOURCE, and leaves it untouched where it says so already.
# An archive of the sources has it in commit.txt, where git writes it.
set(commit unknown)
find_program(git git)
if(git AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${git} -C ${SOURCE} describe --always --dirty --abbrev=12 OUTPUT_VARIABLE found RESULT_VARIABLE status
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(status EQUAL 0)
    set(commit ${found})
  endif()
else()
  file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/commit.txt archived LENGTH_MINIMUM 12)
  if(archived MATCHES "^[0-9a-f]+$")
    string(SUBSTRING ${archived} 0 12 commit)
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[
#include "cli/commit.hpp"

const char* const zwidth::cli::commit = "@commit@";
]] @ONLY)
