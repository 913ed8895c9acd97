#pragma once
/// \file vector_clones.hpp  Functions that are compiled for several widths of vector units, the widest one of the
/// machine running.

/// Before a function of plain loops over a fixed number of lanes. Without contraction into fused operations
/// (-ffp-contract=off) every clone gives the same bits. Sanitizers run before the clones are chosen, so with them there
/// is one.
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && __GNUC__ >= 12 && \
    !defined(__SANITIZE_ADDRESS__)
#define QUADEDGE_VECTOR_CLONES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define QUADEDGE_VECTOR_CLONES
#endif
