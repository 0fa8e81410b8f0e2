// The hot functions are compiled twice, for machines with fused multiply-add and without, and chosen when the program
// is loaded. The fused operations are written out, so both give the same bits; without the instruction it is only
// slower. Clang cannot clone what it flattens: there the options of the build decide (-mfma, -march=native).
//
// What such a function calls must be inlined into it, or it is the version without that runs, each fused multiply-add a
// call of the C library: templates are by themselves, other functions where they are marked.
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
