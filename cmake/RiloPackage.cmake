# Debian packages: librilo<SOVERSION> (libraries), librilo-dev (headers, CMake, pkg-config), rilo (the command).
# `cpack -G DEB` in a build with BUILD_SHARED_LIBS=ON and CMAKE_INSTALL_PREFIX=/usr; scripts/package.sh does it.
set(CPACK_PACKAGE_NAME rilo)
set(CPACK_PACKAGE_VENDOR "The Rilo authors")
set(CPACK_PACKAGE_CONTACT "The Rilo authors <rilo@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL library dev command)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_COMPONENT_COMMAND_DEPENDS library)
set(CPACK_COMPONENT_DEV_DEPENDS library)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "LiDAR-only odometry with a reliable initial pose: shared libraries")
set(CPACK_COMPONENT_DEV_DESCRIPTION "LiDAR-only odometry with a reliable initial pose: headers, CMake and pkg-config files")
set(CPACK_COMPONENT_COMMAND_DESCRIPTION "LiDAR-only odometry with a reliable initial pose: the rilo command")

# The name changes with the ABI, so that two versions of the libraries can stand beside each other.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME librilo${RILO_SOVERSION})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_DEV_PACKAGE_NAME librilo-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME rilo)

# Where Debian looks for the licence of each package.
if(CMAKE_INSTALL_PREFIX STREQUAL CPACK_PACKAGING_INSTALL_PREFIX)
  foreach(component IN LISTS CPACK_COMPONENTS_ALL)
    string(TOUPPER ${component} upper)
    install(FILES ${PROJECT_SOURCE_DIR}/LICENSE RENAME copyright COMPONENT ${component}
      DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  endforeach()
endif()

# What the binaries link is found by dpkg-shlibdeps; our own libraries are not installed while it looks.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/src)
foreach(component IN LISTS RILO_COMPONENTS)
  list(APPEND CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/src/${component})
endforeach()

# Who builds against it needs what rilo-config.cmake asks for: the libraries that scripts/setup.sh installs to build.
execute_process(COMMAND ${PROJECT_SOURCE_DIR}/scripts/setup.sh --minimal --print
  OUTPUT_VARIABLE packages ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
string(REPLACE "\n" ";" packages "${packages}")
list(FILTER packages INCLUDE REGEX "-dev$")
find_package(RosbagStorage QUIET)  # that of src/io is not seen here
if(NOT RosbagStorage_FOUND)
  list(REMOVE_ITEM packages librosbag-storage-dev libnav-msgs-dev libtf2-msgs-dev)
endif()
list(JOIN packages ", " CPACK_DEBIAN_DEV_PACKAGE_DEPENDS)
include(CPack)
