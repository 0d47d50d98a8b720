# Install and export. find_package(rilo) gives rilo::rilo; find_package(rilo COMPONENTS io …) also rilo::io, ….
# What each library links is read from its target, so a new dependency needs one line in the table below, no more.
include(CMakePackageConfigHelpers)
set(RILO_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/rilo)

# Imported target → the find_package call that provides it (spaces written as spaces).
set(RILO_PACKAGE_TABLE
  "Eigen3::Eigen=Eigen3 3.4"
  "TBB::tbb=TBB"
  "yaml-cpp=yaml-cpp"
  "fmt::fmt=fmt"
  "nlohmann_json::nlohmann_json=nlohmann_json"
  "nanoflann::nanoflann=nanoflann"
  "CLI11::CLI11=CLI11"
  "Threads::Threads=Threads"
  "ZLIB::ZLIB=ZLIB"
  "SQLite::SQLite3=SQLite3"
  "ZSTD::zstd=ZSTD"
  "LZ4::lz4=LZ4"
  "PCAP::pcap=PCAP"
  "RosbagStorage::rosbag_storage=RosbagStorage")

# Splits the links of `target` into packages to find and components of ours.
function(rilo_dependencies_of target packages_out components_out)
  get_target_property(links ${target} LINK_LIBRARIES)
  set(packages "")
  set(components "")
  foreach(link IN LISTS links)
    if(link MATCHES "^rilo(::rilo)?$" OR link MATCHES "BUILD_INTERFACE" OR link STREQUAL "links-NOTFOUND")
      continue()
    elseif(link MATCHES "^rilo(::|_)([a-z0-9_]+)$")
      list(APPEND components ${CMAKE_MATCH_2})
      continue()
    endif()
    set(row ${RILO_PACKAGE_TABLE})
    string(REPLACE "+" "\\+" pattern "${link}")
    list(FILTER row INCLUDE REGEX "^${pattern}=")
    if(NOT row)
      message(FATAL_ERROR "${target} links ${link}: add it and its package to RILO_PACKAGE_TABLE in cmake/RiloInstall.cmake")
    endif()
    string(REGEX REPLACE "^[^=]*=" "" package "${row}")
    list(APPEND packages "${package}")
  endforeach()
  set(${packages_out} "${packages}" PARENT_SCOPE)
  set(${components_out} "${components}" PARENT_SCOPE)
endfunction()

# Installs one library and adds its line to the table that rilo-config.cmake reads.
function(rilo_install_library component target)
  install(TARGETS ${target} EXPORT rilo-${component}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT dev)
  install(EXPORT rilo-${component} NAMESPACE rilo:: DESTINATION ${RILO_CMAKE_DIR} FILE rilo-${component}-targets.cmake
    COMPONENT dev)
  rilo_dependencies_of(${target} packages components)
  string(APPEND RILO_CONFIG_TABLE
    "set(_rilo_${component}_packages \"${packages}\")\nset(_rilo_${component}_components \"${components}\")\n"
    "set(_rilo_${component}_required \"\${rilo_FIND_REQUIRED_${component}}\")\n")
  set(RILO_CONFIG_TABLE "${RILO_CONFIG_TABLE}" PARENT_SCOPE)
endfunction()

set(RILO_CONFIG_TABLE "")
get_property(RILO_COMPONENTS GLOBAL PROPERTY RILO_COMPONENTS)
# What docs/abi.md promises: below 1.0 every minor version may break binaries.
set(RILO_SOVERSION ${PROJECT_VERSION_MAJOR})
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(RILO_SOVERSION 0.${PROJECT_VERSION_MINOR})
endif()
set_target_properties(rilo PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${RILO_SOVERSION})
rilo_install_library(core rilo)
foreach(component IN LISTS RILO_COMPONENTS)
  set_target_properties(rilo_${component} PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${RILO_SOVERSION})
  rilo_install_library(${component} rilo_${component})
endforeach()

# Headers: the core's folders, and those of the components that are built. All else lies in src/.
install(FILES ${PROJECT_SOURCE_DIR}/include/rilo/rilo.hpp ${PROJECT_SOURCE_DIR}/include/rilo/stage_config.hpp
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/rilo COMPONENT dev)
foreach(folder geometry cloud calibration odometry ${RILO_COMPONENTS})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/rilo/${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/rilo
    COMPONENT dev FILES_MATCHING PATTERN "*.hpp")
endforeach()

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/rilo-config.cmake.in ${PROJECT_BINARY_DIR}/rilo-config.cmake
  INSTALL_DESTINATION ${RILO_CMAKE_DIR} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/rilo-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/rilo-config.cmake ${PROJECT_BINARY_DIR}/rilo-config-version.cmake
  ${CMAKE_CURRENT_LIST_DIR}/FindLZ4.cmake ${CMAKE_CURRENT_LIST_DIR}/FindPCAP.cmake
  ${CMAKE_CURRENT_LIST_DIR}/FindRosbagStorage.cmake ${CMAKE_CURRENT_LIST_DIR}/FindZSTD.cmake
  DESTINATION ${RILO_CMAKE_DIR} COMPONENT dev)
# Relative, so that `cmake --install --prefix` and moved prefixes work.
file(RELATIVE_PATH RILO_PC_TO_PREFIX "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
configure_file(${CMAKE_CURRENT_LIST_DIR}/rilo.pc.in ${PROJECT_BINARY_DIR}/rilo.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/rilo.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)

if(TARGET rilo_cli)
  install(TARGETS rilo_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/config DESTINATION ${CMAKE_INSTALL_DATADIR}/rilo
    COMPONENT command FILES_MATCHING PATTERN "*.yaml")
  if(NOT CMAKE_CROSSCOMPILING)
    set(docs ${PROJECT_BINARY_DIR}/command_docs)
    install(FILES ${docs}/rilo.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT command)
    install(FILES ${docs}/rilo DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT command)
    install(FILES ${docs}/_rilo DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT command)
    install(FILES ${docs}/rilo.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT command)
  endif()
endif()
# Not with the libraries: two versions of their package must not hold the same file.
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT dev)
if(NOT TARGET uninstall)
  add_custom_target(uninstall
    COMMAND ${CMAKE_COMMAND} -DBUILD_DIR=${PROJECT_BINARY_DIR} -P ${CMAKE_CURRENT_LIST_DIR}/uninstall.cmake VERBATIM)
endif()
include(RiloPackage)
