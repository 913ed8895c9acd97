#pragma once
/// \file ceilings.hpp  A device's ceilings, measured by two small kernels.

#include "opencl/context.hpp"

namespace quadedge::bench {

/// The highest rates measured.
struct Ceilings {
  double bandwidth_gb_s = 0;      ///< bytes read plus bytes written by a copy, 1e9 per second
  double arithmetic_gflop_s = 0;  ///< fused multiply-adds in single precision, two operations each
};

/// Best of `repetitions` runs of both kernels, by OpenCL events. `megabytes`: size of the copied array; should exceed
/// the caches. \throws UsageError for a context without profiling, DeviceError when the device fails.
Ceilings measure_ceilings(opencl::Context& context, int megabytes = 128, int repetitions = 5);

}  // namespace quadedge::bench
