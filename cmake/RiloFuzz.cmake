# Instrumentation for libFuzzer: the libraries count their branches, and the first finding ends the program.
if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  message(FATAL_ERROR "RILO_FUZZ needs Clang, which has libFuzzer: cmake --preset fuzz, or -DCMAKE_CXX_COMPILER=clang++")
endif()
set(RILO_FUZZ_FLAGS -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
add_compile_options(${RILO_FUZZ_FLAGS} -fsanitize=fuzzer-no-link)
add_link_options(${RILO_FUZZ_FLAGS})
