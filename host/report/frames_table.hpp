#pragma once
/// \file frames_table.hpp  frames.csv read back.

#include <string>
#include <utility>
#include <vector>

namespace quadedge::report {

/// The rows of a frames.csv, column by column; each column as long as `stamp_s`.
struct FramesTable {
  std::vector<double> stamp_s;
  std::vector<std::string> status;
  std::vector<bool> new_key_rig;
  std::vector<double> latency_ms;
  /// Counts of edges, stereo edges, quads, ... and stage times [ms], in the order of the file; NaN where a field is
  /// empty.
  std::vector<std::pair<std::string, std::vector<double>>> counts, stages_ms;
};

/// \throws DataError for a missing file or one that is no frames.csv.
FramesTable read_frames_table(const std::string& file);

/// Reads one line of a CSV file (RFC 4180, one line per record).
std::vector<std::string> csv_fields(const std::string& line);

}  // namespace quadedge::report
