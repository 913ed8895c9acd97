#include "cli/estimate_tables.hpp"

#include <algorithm>
#include <cstdio>

namespace quadedge::cli {
namespace {

constexpr std::size_t kLargest = 3;

/// What keeps the frame from the model's goal, and the longest stages.
void print_verdict(const bench::FrameEstimate& estimate) {
  std::printf("estimate: the longest stages are");
  const auto stages = estimate.by_time();
  for (std::size_t i = 0; i < std::min(kLargest, stages.size()); ++i)
    std::printf("%s %s (%s)", i == 0 ? "" : ",", stages[i].stage.c_str(), stages[i].bound().c_str());
  std::printf("\n");
  const double goal = estimate.model.goal_ms;
  if (goal == 0) return;
  if (estimate.frame_ms() <= goal) {
    std::printf("estimate: within the goal of %g ms\n", goal);
    return;
  }
  std::printf("estimate: %.3f ms beyond the goal of %g ms; in the way:", estimate.frame_ms() - goal, goal);
  for (const auto& name : estimate.in_the_way()) std::printf(" %s", name.c_str());
  std::printf("\n");
}

}  // namespace

void print_count(const bench::FrameCount& count, const report::InputFacts& input, const DeviceInfo& device) {
  std::printf("counted: %s, %dx%d, %.0f and %.0f edges, mean of %d frames, %d of them tracked\n", input.name.c_str(),
              input.width, input.height, count.left_edges, count.right_edges, count.frames, count.tracked);
  std::printf("with the kernel forms of GPUs, which were run for it on %s\n", device.name.c_str());
  std::printf("least work: every input read and every output written once\n\n");
  std::printf("%-20s %10s %10s %9s %9s %9s %12s %12s\n", "stage", "MB", "Mflop", "launches", "writes", "waits",
              "to device MB", "to host MB");
  for (const auto& stage : count.stages) {
    std::printf("%-20s %10.3f %10.1f %9.1f %9.1f %9.1f %12.3f %12.3f\n", stage.stage.c_str(), stage.work.bytes * 1e-6,
                stage.work.operations * 1e-6, stage.launches, stage.writes, stage.waits, stage.to_device * 1e-6,
                stage.to_host * 1e-6);
  }
}

void print_estimate(const bench::FrameEstimate& estimate) {
  const auto& model = estimate.model;
  std::printf("\nESTIMATE, not measured: a tracked frame on the model %s (%s)\n", model.name.c_str(),
              model.file.c_str());
  std::printf(
      "memory %g GB/s x %g, arithmetic %g GFLOP/s x %g, copies %g GB/s x %g, %g us per launch, %g us per wait\n",
      model.memory_gb_s, model.memory_attainable, model.arithmetic_gflop_s, model.arithmetic_attainable,
      model.transfer_gb_s, model.transfer_attainable, model.launch_us, model.wait_us);
  std::printf("source: %s\nassumed: %s\n\n", model.source.c_str(), model.assumptions.c_str());
  std::printf("%-20s %10s %10s %10s %10s %10s %12s %7s  %s\n", "estimate [ms]", "memory", "arithmetic", "launches",
              "waits", "transfers", "stage", "share", "bound by");
  const double frame_ms = estimate.frame_ms();
  for (const auto& stage : estimate.stages) {
    std::printf("%-20s %10.4f %10.4f %10.4f %10.4f %10.4f %12.4f %5.1f %%  %s\n", stage.stage.c_str(), stage.memory_ms,
                stage.arithmetic_ms, stage.launches_ms, stage.waits_ms, stage.transfers_ms, stage.total_ms(),
                100 * stage.total_ms() / frame_ms, stage.bound().c_str());
  }
  const auto sum = [&](const char* name, double ms, const char* what) {
    std::printf("%-20s %10s %10s %10s %10s %10s %12.4f %5.1f %%  %s\n", name, "", "", "", "", "", ms,
                100 * ms / frame_ms, what);
  };
  sum("device", estimate.device_ms(), "estimate");
  sum("host", estimate.host_ms, "measured on this machine");
  sum("frame", frame_ms, "estimate");
  print_verdict(estimate);
}

}  // namespace quadedge::cli
