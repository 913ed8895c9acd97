#include "benchmark/bench_record.hpp"

#include "report/statistics.hpp"

namespace quadedge::bench {

double FrameShares::host_ms() const {
  double device = 0;
  for (const auto& stage : stages) device += stage.wall_ms();
  return frame_ms - device;
}

FrameShares BenchRecord::shares() const {
  FrameShares mean;
  if (profiled.empty()) return mean;
  const double scale = 1 / static_cast<double>(profiled.size());
  for (const auto& frame : profiled) {
    mean.frame_ms += frame.frame_ms * scale;
    for (const auto& stage : frame.stages) {
      std::size_t row = 0;
      while (row < mean.stages.size() && mean.stages[row].stage != stage.stage) ++row;
      if (row == mean.stages.size()) mean.stages.emplace_back().stage = stage.stage;
      mean.stages[row].kernel_ms += stage.kernel_ms * scale;
      mean.stages[row].transfer_ms += stage.transfer_ms * scale;
      mean.stages[row].queue_ms += stage.queue_ms * scale;
      mean.stages[row].launches += stage.launches * scale;
    }
  }
  return mean;
}

double BenchRecord::frame_ratio() const {
  return report::latency_summary(run.frames).median /
         report::median(yardsticks ? yardsticks->sift_both_ms : std::vector<double>());
}

double BenchRecord::edges_ratio() const {
  return report::median(edges_ms) / report::median(yardsticks ? yardsticks->sepfilter_nine_ms : std::vector<double>());
}

}  // namespace quadedge::bench
