# Language level, warnings and the build type that speed and tests are measured with.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
# Shared builds (-DBUILD_SHARED_LIBS=ON): the installed command finds its libraries wherever the prefix is moved.
set(CMAKE_INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
# -ffp-contract=off: the same bits whatever the compiler would fuse; -fno-math-errno: sqrt becomes one instruction;
# -fno-trapping-math: conditions on numbers become vector instructions.
add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off;-fno-math-errno;-fno-trapping-math>")

# Our own targets get every warning; headers of dependencies are system headers and stay silent.
function(rilo_set_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-restrict)  # wrong about operator+ of std::string (GCC bug 105651)
  endif()
  if(RILO_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# A library of the command and its tests alone, with its headers beside its sources: target rilo_NAME.
function(rilo_add_internal_library name)
  add_library(rilo_${name} STATIC ${ARGN})
  target_include_directories(rilo_${name} PUBLIC "${PROJECT_SOURCE_DIR}/src")
  rilo_set_warnings(rilo_${name})
endfunction()

# One library of ours beside the core: target rilo_NAME, alias and exported name rilo::NAME; RiloInstall installs it
# as component NAME of find_package(rilo).
function(rilo_add_library name)
  add_library(rilo_${name} ${ARGN})
  add_library(rilo::${name} ALIAS rilo_${name})
  set_target_properties(rilo_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(rilo_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  rilo_set_warnings(rilo_${name})
  set_property(GLOBAL APPEND PROPERTY RILO_COMPONENTS ${name})
endfunction()
