#include "cli/loop_output.hpp"

#include <algorithm>

#include "common/run_cost.hpp"
#include "data/atomic_file.hpp"
#include "report/loops_csv.hpp"

namespace quadedge::cli {

void LoopOutput::add(const FrameResult& result) {
  const auto start = Clock::now();
  map_.add(result);
  const double ms = milliseconds_since(start);
  total_ms_ += ms;
  latencies_ms_.push_back(result.timing.latency_ms + ms);
}

report::LoopFacts LoopOutput::write(const std::string& folder, const std::string& saved_map) const {
  const Trajectory trajectory = map_.trajectory();
  write_tum(folder + "/trajectory_map.txt", trajectory);
  data::write_atomically(folder + "/loops.csv", report::loops_csv(map_.closures()));
  if (!saved_map.empty()) write_map(saved_map, map_.saved());
  report::LoopFacts facts;
  facts.compared = map_.closures().size();
  facts.kept = static_cast<std::size_t>(
      std::count_if(map_.closures().begin(), map_.closures().end(),
                    [](const Closure& closure) { return closure.verdict == ClosureVerdict::kept; }));
  facts.segments = map_.segments();
  facts.frames = trajectory.size();
  facts.key_rigs = map_.key_rigs();
  facts.megabytes = static_cast<double>(map_.bytes()) / 1e6;
  facts.total_ms = total_ms_;
  facts.latency = report::latency_summary(latencies_ms_);
  return facts;
}

}  // namespace quadedge::cli
