#pragma once

// Marks a function whose loops the compiler shall also build for AVX2; the machine takes the best
// that it has. All builds give the same bits: such files are compiled without contraction of
// multiply and add, and no loop sums in another order than written.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !defined(VS_SIM_ONE_BUILD)
#define VS_SIM_CLONES __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define VS_SIM_CLONES
#endif
