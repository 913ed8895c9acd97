#pragma once
/// \file argument_structs.hpp  The structures of kernels/layouts.cl as kernel arguments.

#include <cstddef>

#include "common/layouts.hpp"
#include "opencl/kernel.hpp"

/// Every structure of kernels/layouts.cl; tests/test_layouts.cpp holds the list complete.
#define QUADEDGE_KERNEL_STRUCTS(VISIT) \
  VISIT(FilterLimits)                  \
  VISIT(FilterArguments)

namespace quadedge::opencl {

#define QUADEDGE_DESCRIBE(NAME)                 \
  template <>                                   \
  struct TypeName<NAME> {                       \
    static constexpr const char* value = #NAME; \
  };
QUADEDGE_KERNEL_STRUCTS(QUADEDGE_DESCRIBE)
#undef QUADEDGE_DESCRIBE

}  // namespace quadedge::opencl
