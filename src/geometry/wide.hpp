// Functions for wider vector registers than those that every machine has.
#pragma once

// Compiled for eight lanes too, and chosen by what the processor has; the bits are the same. Sanitizers cannot run
// what chooses.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define RILO_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define RILO_WIDE
#endif
