// Innermost loops for the processor that the program runs on.
#pragma once

/// A function that is compiled for wider vectors too; the processor's kind decides when the program starts. Sanitizers can't live with
/// functions that are chosen before they are set up.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SOTERRAIN_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define SOTERRAIN_VECTOR_CLONES
#endif
