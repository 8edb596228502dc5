# What the program carries in itself: zwidth_embedded_sources. The front end is built in web/ with Debian's nodejs and npm
# (ZWIDTH_WEB=ON), or was before (ZWIDTH_FRONT_END); without it the program serves a page that says how.
set(embed ${PROJECT_SOURCE_DIR}/cmake/zwidth_embed.cmake)

file(GLOB_RECURSE devices CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/devices/*.toml ${PROJECT_SOURCE_DIR}/devices/*.xml)
set(devices_source ${CMAKE_CURRENT_BINARY_DIR}/embedded_devices.cpp)
add_custom_command(OUTPUT ${devices_source} DEPENDS ${devices} ${embed} VERBATIM
  COMMAND ${CMAKE_COMMAND} -D FOLDER=${PROJECT_SOURCE_DIR}/devices -D "PATTERNS=*.toml;*.xml" -D FUNCTION=embedded_devices
    -D OUTPUT=${devices_source} -P ${embed})

set(web ${PROJECT_SOURCE_DIR}/web)
set(web_source ${CMAKE_CURRENT_BINARY_DIR}/embedded_front_end.cpp)
if(ZWIDTH_FRONT_END)
  set(web_files ${ZWIDTH_FRONT_END})
elseif(ZWIDTH_WEB)
  find_program(npm npm REQUIRED)
  set(web_files ${web}/dist)
  file(GLOB_RECURSE web_inputs CONFIGURE_DEPENDS ${web}/src/* ${web}/public/*)
  list(FILTER web_inputs EXCLUDE REGEX /api/generated/)  # "npm run build" writes it
  file(GLOB schemas CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/docs/schemas/*.json)
  file(GLOB web_settings CONFIGURE_DEPENDS ${web}/*.json ${web}/*.ts ${web}/*.js ${web}/*.html)
  # "npm ci" where the lock file has changed since, or was never installed.
  add_custom_command(OUTPUT ${web}/node_modules/.package-lock.json DEPENDS ${web}/package-lock.json VERBATIM
    WORKING_DIRECTORY ${web}
    COMMAND ${npm} ci --no-audit --no-fund
    COMMAND ${CMAKE_COMMAND} -E touch node_modules/.package-lock.json
    COMMENT "Fetching what the front end is built with" USES_TERMINAL)
  add_custom_command(OUTPUT ${web}/dist/index.html VERBATIM WORKING_DIRECTORY ${web}
    DEPENDS ${web_inputs} ${web_settings} ${schemas} ${web}/scripts/documents.mjs ${web}/node_modules/.package-lock.json
    COMMAND ${npm} run build
    COMMAND ${CMAKE_COMMAND} -E touch dist/index.html
    COMMENT "Building the front end")
else()
  set(web_files ${PROJECT_SOURCE_DIR}/apps/server/http/without_web)
endif()
add_custom_command(OUTPUT ${web_source} DEPENDS ${web_files}/index.html ${embed} VERBATIM
  COMMAND ${CMAKE_COMMAND} -D FOLDER=${web_files} -D PATTERNS=* -D FUNCTION=embedded_front_end -D GZIP=ON
    -D OUTPUT=${web_source} -P ${embed})

set(zwidth_embedded_sources ${devices_source} ${web_source})
set_source_files_properties(${zwidth_embedded_sources} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
