# Asks for every required package at once: one message names all that are missing and how to install them, instead of
# one configure run per package. Optional ones (Boost, librosbag-storage, npm) are asked for where they are used.

# find_package call = Debian package. The lists are those of the targets that link them.
set(RILO_CORE_REQUIREMENTS "Eigen3 3.4 NO_MODULE=libeigen3-dev" "TBB=libtbb-dev" "nanoflann=libnanoflann-dev")
set(RILO_APP_REQUIREMENTS
  "CLI11=libcli11-dev"
  "fmt=libfmt-dev"
  "LZ4=liblz4-dev"
  "nlohmann_json=nlohmann-json3-dev"
  "OpenSSL COMPONENTS Crypto=libssl-dev"
  "PCAP=libpcap-dev"
  "PNG=libpng-dev"
  "SQLite3=libsqlite3-dev"
  "yaml-cpp=libyaml-cpp-dev"
  "ZLIB=zlib1g-dev"
  "ZSTD=libzstd-dev")

set(rilo_requirements ${RILO_CORE_REQUIREMENTS})
if(RILO_BUILD_APPS)
  list(APPEND rilo_requirements ${RILO_APP_REQUIREMENTS})
endif()
set(rilo_missing "")
set(rilo_missing_packages "")
foreach(requirement IN LISTS rilo_requirements)
  string(REGEX MATCH "^([^=]*)=(.*)$" matched "${requirement}")
  set(package "${CMAKE_MATCH_2}")
  separate_arguments(arguments UNIX_COMMAND "${CMAKE_MATCH_1}")
  list(GET arguments 0 name)
  find_package(${arguments} QUIET)
  if(NOT ${name}_FOUND)
    string(APPEND rilo_missing "  ${name} (Debian, Ubuntu: ${package})\n")
    string(APPEND rilo_missing_packages " ${package}")
  endif()
endforeach()
if(rilo_missing)
  message(FATAL_ERROR "Rilo cannot be built: these libraries and their headers are missing:\n${rilo_missing}"
    "Install them, then build again. On Debian or Ubuntu:\n"
    "  apt-get install${rilo_missing_packages}\n"
    "Installed in another place: name it with -DCMAKE_PREFIX_PATH=FOLDER "
    "(pip: CMAKE_PREFIX_PATH=FOLDER in the environment).")
endif()
