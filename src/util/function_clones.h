// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Compiles a function twice, for CPUs with and without AVX2 and POPCNT; the loader chooses one.
// Only for integer code, because results must not depend on the CPU. Programs built with sanitizers
// do not start with such functions, so there the macro is empty.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define HULLSLAM_FUNCTION_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define HULLSLAM_FUNCTION_CLONES
#endif
