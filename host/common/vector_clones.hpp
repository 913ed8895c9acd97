#pragma once
/// \file vector_clones.hpp  Compiles a function for several vector widths, of which the widest supported one is chosen
/// at run time.

/// To be placed before functions with plain loops over a fixed number of lanes. Without contraction into fused
/// operations (-ffp-contract=off), all clones give identical bits. Sanitizers run before the clone is chosen; with
/// them, there is only one.
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && __GNUC__ >= 12 && \
    !defined(__SANITIZE_ADDRESS__)
#define QUADEDGE_VECTOR_CLONES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define QUADEDGE_VECTOR_CLONES
#endif
