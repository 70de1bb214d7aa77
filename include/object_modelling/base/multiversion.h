#pragma once

/// Before the definition of a function: it is compiled twice, for any x86-64 and for processors with AVX2, and the
/// loader picks. Sanitizers run before the loader could ask, and other compilers and processors do without.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__gnu_linux__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define OBJECT_MODELLING_MULTIVERSION __attribute__((target_clones("avx2", "default")))
#else
#define OBJECT_MODELLING_MULTIVERSION
#endif
