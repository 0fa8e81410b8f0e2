// The hot functions are compiled twice, for machines with and without fused multiply-add; the loader chooses one. Fused
// operations are written out, so both versions give the same bits. Clang cannot clone flattened functions: there the
// options of the build decide (-mfma, -march=native).
//
// A function that such a function calls must be inlined into it. Otherwise the version without the instruction runs,
// and each fused multiply-add is a call of the C library. Templates are inlined by themselves, other functions with
// AFM_INLINED.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && !defined(AFM_SINGLE_VERSION)
#define AFM_MULTIVERSION __attribute__((flatten, target_clones("fma", "default")))
#else
#define AFM_MULTIVERSION
#endif

#if defined(__GNUC__)
#define AFM_INLINED inline __attribute__((always_inline))
#else
#define AFM_INLINED inline
#endif
