# zwidth_find_header(VARIABLE HEADER PACKAGE [SUFFIX...]): the folder that holds HEADER, or an end that names its package.
function(zwidth_find_header variable header package)
  find_path(${variable} ${header} PATH_SUFFIXES ${ARGN})
  if(NOT ${variable})
    message(FATAL_ERROR "zwidth needs the header ${header}: install Debian's ${package} (scripts/install-dependencies demo), "
      "or give its folder as -D ${variable}=FOLDER")
  endif()
endfunction()
