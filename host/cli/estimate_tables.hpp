#pragma once
/// \file estimate_tables.hpp  The tables of `compare --device-model` on stdout.

#include "benchmark/roofline.hpp"
#include "report/run_record.hpp"

namespace quadedge::cli {

/// What was counted, on which input and device.
void print_count(const bench::FrameCount& count, const report::InputFacts& input, const DeviceInfo& device);

/// The estimate on one model, and what keeps it from the goal.
void print_estimate(const bench::FrameEstimate& estimate);

}  // namespace quadedge::cli
