// Innermost loops for the processor that the program runs on.
#pragma once

/// A function that is compiled for wider vectors too; the processor's kind decides when the program starts. Sanitizers can't live with
/// functions that are chosen before they are set up.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SOTERRAIN_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define SOTERRAIN_SANITIZED
#endif
#endif

#if defined(__x86_64__) && !defined(SOTERRAIN_SANITIZED)
#define SOTERRAIN_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define SOTERRAIN_VECTOR_CLONES
#endif
