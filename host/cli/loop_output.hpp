#pragma once
/// \file loop_output.hpp  The corrected trajectory and the closures that a run writes.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "quadedge/map.hpp"
#include "report/run_record.hpp"

namespace quadedge::cli {

/// The map of places beside the odometry of a run, with --loops.
class LoopOutput {
 public:
  explicit LoopOutput(StereoOdometry& odometry) : map_(odometry) {}

  /// Takes in the frame that was tracked last.
  void add(const FrameResult& result);
  const Map& map() const { return map_; }
  /// Writes trajectory_map.txt and loops.csv and, unless its name is empty, a map file. \throws DataError. \returns
  /// what they hold
  report::LoopFacts write(const std::string& folder, const std::string& saved_map) const;

 private:
  Map map_;
  double total_ms_ = 0;
  std::vector<double> latencies_ms_;  ///< of all frames, with the time of the map
};

}  // namespace quadedge::cli
