# cmake -D FOLDER=... -D PATTERNS="*.toml" -D FUNCTION=embedded_devices -D OUTPUT=x.cpp [-D GZIP=ON] -P zwidth_embed.cmake
# Writes a source that puts the files of FOLDER into the program as they are, or gzipped; see
# apps/server/http/embedded_files.hpp. The assembler copies the bytes: nothing is turned into source.
cmake_path(REMOVE_EXTENSION OUTPUT OUTPUT_VARIABLE copies)
file(REMOVE_RECURSE ${copies})
file(MAKE_DIRECTORY ${copies})
set(files)
foreach(pattern IN LISTS PATTERNS)
  file(GLOB_RECURSE found LIST_DIRECTORIES OFF RELATIVE ${FOLDER} ${FOLDER}/${pattern})
  list(APPEND files ${found})
endforeach()
list(SORT files)
if(NOT files)
  message(FATAL_ERROR "nothing to embed in ${FOLDER}")
endif()

set(declarations)
set(entries)
set(number 0)
foreach(file IN LISTS files)
  if(NOT file MATCHES "^[A-Za-z0-9_./-]+$")
    message(FATAL_ERROR "${FOLDER}/${file}: rename it: letters, digits, '_', '.', '-'")
  endif()
  set(copy ${copies}/${number})
  if(GZIP)
    file(ARCHIVE_CREATE OUTPUT ${copy} PATHS ${FOLDER}/${file} FORMAT raw COMPRESSION GZip)
  else()
    file(COPY_FILE ${FOLDER}/${file} ${copy})
  endif()
  set(symbol ${FUNCTION}_${number})
  string(APPEND declarations "asm(\".section .rodata\\n${symbol}_begin:\\n.incbin \\\"${copy}\\\"\\n${symbol}_end:\\n.byte 0\\n.previous\");
extern \"C\" const char ${symbol}_begin[];
extern \"C\" const char ${symbol}_end[];
")
  string(APPEND entries "      {\"${file}\", {${symbol}_begin, static_cast<std::size_t>(${symbol}_end - ${symbol}_begin)}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUTPUT} "// Written by cmake/zwidth_embed.cmake.
#include <array>

#include \"server/http/embedded_files.hpp\"

${declarations}
std::span<const zwidth::server::EmbeddedFile> zwidth::server::${FUNCTION}() {
  static const std::array<EmbeddedFile, ${number}> files{{
${entries}  }};
  return files;
}
")
