#pragma once
/// \file argument_structs.hpp  The structures of kernels/layouts.cl as kernel arguments.

#include <cstddef>

#include "common/layouts.hpp"
#include "opencl/kernel.hpp"

/// Every structure of kernels/layouts.cl; tests/test_layouts.cpp verifies that the list is complete.
#define QUADEDGE_KERNEL_STRUCTS(VISIT) \
  VISIT(PackedPositions)               \
  VISIT(PackedPointIndex)              \
  VISIT(EpipolarGeometry)              \
  VISIT(AlignmentSettings)             \
  VISIT(ThresholdArguments)            \
  VISIT(DetectionArguments)            \
  VISIT(EpipolarRows)                  \
  VISIT(SelectionArguments)            \
  VISIT(PatchArguments)                \
  VISIT(SiftArguments)                 \
  VISIT(DisparityProbe)                \
  VISIT(StereoCandidateArguments)      \
  VISIT(FilterLimits)                  \
  VISIT(FilterArguments)               \
  VISIT(StereoRefinementArguments)     \
  VISIT(StereoClusterArguments)        \
  VISIT(CoarseDisparityArguments)      \
  VISIT(StereoRelaxationArguments)     \
  VISIT(StereoMutualArguments)         \
  VISIT(PointIndexArguments)           \
  VISIT(TemporalCandidateArguments)    \
  VISIT(QuadChoice)                    \
  VISIT(TemporalMatchArguments)        \
  VISIT(TemporalAgreementArguments)    \
  VISIT(TemporalBestArguments)         \
  VISIT(WideSelection)                 \
  VISIT(WideMatchingArguments)

namespace quadedge::opencl {

#define QUADEDGE_DESCRIBE(NAME)                 \
  template <>                                   \
  struct TypeName<NAME> {                       \
    static constexpr const char* value = #NAME; \
  };
QUADEDGE_KERNEL_STRUCTS(QUADEDGE_DESCRIBE)
#undef QUADEDGE_DESCRIBE

}  // namespace quadedge::opencl
