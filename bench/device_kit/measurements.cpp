/// \file measurements.cpp  The parts of device_check that measure time.
#include <algorithm>
#include <cmath>

#include "benchmark/ceilings.hpp"
#include "benchmark/latency.hpp"
#include "benchmark/variant_comparison.hpp"
#include "common/disparity_range.hpp"
#include "device_kit/parts.hpp"
#include "quadedge/error.hpp"
#include "report/statistics.hpp"

namespace device_kit {

using namespace quadedge;

void variants_part(const Options& options) {
  constexpr int kRepetitions = 9;
  const Sequence sequence = options.sequence();
  const Config config = with_disparity_range(options.preset("default"), sequence.rig);
  const Frame &first = sequence.frames.at(0), &second = sequence.frames.at(1);
  Device device = options.open_device(true);
  const bench::ReferenceCheck check(config);
  const bench::Ceilings ceilings = bench::measure_ceilings(*device.context());
  options.rows.add("ceilings", {{"bandwidth [GB/s]", number(ceilings.bandwidth_gb_s)},
                                {"arithmetic [GFLOP/s]", number(ceilings.arithmetic_gflop_s)}});
  const bench::FrameSize size =
      bench::count_frame(*frontend::make_frontend(sequence.rig, device, config), first, second, config);
  const bench::VariantInput input{sequence.rig, first, second, config, [&] { return options.open_device(true); },
                                  kRepetitions, size};
  for (const auto& stage : bench::stages_with_variants()) {
    const auto result = bench::compare_variants(stage, input, check, ceilings, [](const std::string&) {});
    for (const auto& variant : result.variants) {
      const std::string mark = variant.name == result.best() ? "best" : "";
      options.rows.add("variants", {{"stage", stage},
                                    {"variant", variant.name},
                                    {"role", variant.is_default ? "default" : mark},
                                    {"bytes", !variant.runs    ? "cannot run"
                                              : variant.agrees ? "equal"
                                                               : "DIFFER"},
                                    {"median [ms]", number(variant.median_ms)},
                                    {"p10", number(variant.p10_ms)},
                                    {"p90", number(variant.p90_ms)},
                                    {"ratio", number(variant.ratio_to_default)},
                                    {"ratio, p90", number(variant.ratio_p90)},
                                    {"bandwidth [%]", number(100 * variant.bandwidth_share)},
                                    {"arithmetic [%]", number(100 * variant.arithmetic_share)},
                                    {"note", variant.why}});
    }
  }
}

namespace {

/// The sequence forwards and backwards until there are `count` frames, with stamps that go on.
std::vector<Frame> replayed(const Sequence& sequence, std::size_t count) {
  const std::size_t last = sequence.frames.size() - 1;
  const std::int64_t step = sequence.frames.at(1).stamp_ns - sequence.frames.at(0).stamp_ns;
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t turn = i % (2 * last);
    frames.push_back(sequence.frames[turn <= last ? turn : 2 * last - turn]);
    frames.back().stamp_ns = static_cast<std::int64_t>(i) * step;
  }
  return frames;
}

void add_latency(const Rows& rows, const Row& what, const bench::BenchRecord& record) {
  const auto& run = record.run;
  const auto latency = report::latency_summary(run.frames);
  Row row = what;
  for (const auto& [column, value] : Row{{"frames", std::to_string(run.frames.size() - 1)},
                                         {"tracked", std::to_string(run.tracked() - 1)},
                                         {"median [ms]", number(latency.median)},
                                         {"p90", number(latency.p90)},
                                         {"p99", number(latency.p99)},
                                         {"first frame", number(latency.first)},
                                         {"start", number(run.start_ms)},
                                         {"processor time", number(report::median(record.processor_ms))},
                                         {"launches", number(record.launches)},
                                         {"writes", number(record.writes)},
                                         {"waits", number(record.waits)},
                                         {"MB to the device", number(record.to_device_mb)},
                                         {"MB to the host", number(record.to_host_mb)},
                                         {"device memory [MB]", number(run.device_peak_mb)}})
    row.emplace_back(column, value);
  rows.add("latency", row);
}

void add_shares(const Rows& rows, const Row& what, const bench::FrameShares& shares) {
  opencl::StageProfile sum;
  Row times = what;
  for (const auto& stage : shares.stages) {
    sum.kernel_ms += stage.kernel_ms;
    sum.transfer_ms += stage.transfer_ms;
    sum.queue_ms += stage.queue_ms;
    times.emplace_back(stage.stage, number(stage.kernel_ms));
  }
  const auto percent = [&](double ms) { return number(100 * ms / shares.frame_ms); };
  Row row = what;
  for (const auto& [column, value] : Row{{"frame [ms]", number(shares.frame_ms)},
                                         {"kernels [ms]", number(sum.kernel_ms)},
                                         {"transfers [ms]", number(sum.transfer_ms)},
                                         {"driver [ms]", number(sum.queue_ms)},
                                         {"host [ms]", number(shares.host_ms())},
                                         {"kernels [%]", percent(sum.kernel_ms)},
                                         {"transfers [%]", percent(sum.transfer_ms)},
                                         {"driver [%]", percent(sum.queue_ms)},
                                         {"host [%]", percent(shares.host_ms())}})
    row.emplace_back(column, value);
  rows.add("shares", row);
  rows.add("stage_times", times);
}

}  // namespace

void bench_part(const Options& options) {
  constexpr std::size_t kMostFrames = 150;
  const Sequence sequence = options.sequence();
  const std::string& preset = options.argument(1);
  const double seconds = std::stod(options.argument(2));
  bench::BenchRecord record;
  record.warm_up = 3;
  record.run.config = options.preset(preset);
  bench::measure_start(
      sequence.rig, [&] { return options.open_device(false); }, [](const Device&, Config&) {}, record);
  const auto measure = [&](std::size_t count, auto pass) {
    const auto frames = replayed(sequence, count);
    const bench::Subject subject{sequence.rig, frames, record.run.config,
                                 [&](bool profiling) { return options.open_device(profiling); },
                                 [](const char*, int, int) {}};
    pass(subject, record);
  };
  // As many frames as two passes have time for, by a short pass.
  bench::BenchRecord trial = record;
  measure(sequence.frames.size(),
          [&](const bench::Subject& subject, auto&) { bench::measure_latency(subject, trial); });
  const double frame_ms = report::latency_summary(trial.run.frames).median;
  const auto possible = static_cast<std::size_t>(std::max(0.0, 1e3 * seconds / (3 * frame_ms)));
  const std::size_t count = std::clamp(possible, sequence.frames.size(), kMostFrames);
  measure(count, bench::measure_latency);
  const Row what = {{"sequence", sequence.name}, {"preset", preset}};
  add_latency(options.rows, what, record);
  measure(count, bench::measure_kernels);
  add_shares(options.rows, what, record.shares());
}

}  // namespace device_kit
