#pragma once
/// \file frames_csv.hpp  frames.csv: one row per input frame, written while the run goes on.

#include <string>
#include <vector>

#include "quadedge/odometry.hpp"
#include "report/append_file.hpp"

namespace quadedge::report {

/// Columns: frame, stamp_s, status, key_rig, new_key_rig, edge_threshold, the counts, matched_ratio, epipolar_residual,
/// moving_ratio, ambiguous_motion, latency_ms, one NAME_ms per stage, warning, message.
class FramesCsv {
 public:
  /// \throws DataError when the file cannot be written.
  explicit FramesCsv(const std::string& path);
  /// Adds the row of the next frame. A stage that was not seen before adds a column: the file is written anew. Nothing
  /// is kept of the frames, so that long runs do not grow.
  void add(const FrameResult& result);

 private:
  std::string header() const;
  std::string row(const FrameResult& result) const;
  void add_empty_columns(std::size_t count);

  std::string path_;
  AppendFile file_;
  std::vector<std::string> stages_;
  int frames_ = 0;
};

}  // namespace quadedge::report
