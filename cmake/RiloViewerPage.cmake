# The viewer's page: npm fetches its packages when CMake configures, Vite builds it with everything else. Sets
# RILO_PAGE_SOURCE to the C++ source that holds it, or to nothing where npm or its registry is out of reach.
set(RILO_PAGE_SOURCE "")
set(RILO_WEB_DIR ${PROJECT_BINARY_DIR}/web)
if(NOT RILO_VIEWER_PAGE)
  return()
endif()
# Python's source package carries the page as it was built, in place of its sources.
if(NOT EXISTS ${PROJECT_SOURCE_DIR}/web/package-lock.json)
  if(EXISTS ${PROJECT_SOURCE_DIR}/build/release/web/page_files.cpp)
    set(RILO_PAGE_SOURCE ${PROJECT_SOURCE_DIR}/build/release/web/page_files.cpp)
  endif()
  return()
endif()
find_program(RILO_NODE NAMES node nodejs)
find_program(RILO_NPM npm)
mark_as_advanced(RILO_NODE RILO_NPM)
if(NOT RILO_NODE OR NOT RILO_NPM)
  message(STATUS "Viewer's page not built: install nodejs and npm")
  return()
endif()

# Only what is in the lock file, and no scripts of packages. Not repeated while the lock file stays the same.
file(SHA256 ${PROJECT_SOURCE_DIR}/web/package-lock.json lock)
set(stamp ${RILO_WEB_DIR}/.fetched)
set(fetched "")
if(EXISTS ${stamp})
  file(READ ${stamp} fetched)
endif()
if(NOT fetched STREQUAL lock)
  file(COPY ${PROJECT_SOURCE_DIR}/web/package.json ${PROJECT_SOURCE_DIR}/web/package-lock.json DESTINATION ${RILO_WEB_DIR})
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E env npm_config_fetch_retries=1 npm_config_fetch_timeout=20000
      ${RILO_NPM} ci --ignore-scripts --no-audit --no-fund --prefer-offline
    WORKING_DIRECTORY ${RILO_WEB_DIR} RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE errors TIMEOUT 300)
  if(NOT result EQUAL 0)
    string(REGEX MATCH "npm (error|ERR!)[^\n]*" first "${errors}")
    message(STATUS "Viewer's page not built: npm could not fetch its packages (${first})")
    return()
  endif()
  file(WRITE ${stamp} ${lock})
endif()

file(GLOB page_files CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/web ${PROJECT_SOURCE_DIR}/web/src/*
  ${PROJECT_SOURCE_DIR}/web/*.html ${PROJECT_SOURCE_DIR}/web/*.js ${PROJECT_SOURCE_DIR}/web/*.mjs)
list(TRANSFORM page_files PREPEND ${PROJECT_SOURCE_DIR}/web/ OUTPUT_VARIABLE page_sources)
set(RILO_PAGE_SOURCE ${RILO_WEB_DIR}/page_files.cpp)
add_custom_command(OUTPUT ${RILO_PAGE_SOURCE}
  COMMAND ${CMAKE_COMMAND} -E copy_directory ${PROJECT_SOURCE_DIR}/web/src src
  COMMAND ${CMAKE_COMMAND} -E copy ${PROJECT_SOURCE_DIR}/web/index.html ${PROJECT_SOURCE_DIR}/web/vite.config.js
    ${PROJECT_SOURCE_DIR}/web/pack.mjs .
  COMMAND ${RILO_NODE} node_modules/vite/bin/vite.js build --logLevel warn
  COMMAND ${RILO_NODE} pack.mjs dist ${RILO_PAGE_SOURCE} node_modules/three/LICENSE node_modules/uplot/LICENSE
  WORKING_DIRECTORY ${RILO_WEB_DIR} DEPENDS ${page_sources} ${stamp} VERBATIM COMMENT "Building the viewer's page")
