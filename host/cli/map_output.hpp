#pragma once
/// \file map_output.hpp  The map that a run writes.

#include <memory>
#include <optional>
#include <string>

#include "cli/command.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/edge_map.hpp"
#include "quadedge/map.hpp"
#include "report/run_record.hpp"

namespace quadedge::cli {

/// What map to write, if any.
struct MapFiles {
  std::string ply;     ///< file; empty: none
  std::string colmap;  ///< folder; empty: none
  int min_views = EdgeMapOptions().min_views;

  /// --map, --map-colmap, --map-min-views.
  void declare(Options& options);
  bool is_wanted() const { return !ply.empty() || !colmap.empty(); }
  /// Checks the files before long work. \throws UsageError, DataError for files that cannot be written, or that exist
  /// without `force`.
  void check(bool force) const;
};

/// Collects the map of a run and writes it at the end; does nothing if no map is requested.
class MapOutput {
 public:
  MapOutput(const MapFiles& files, const Config& config);
  /// Takes in the frame that was tracked last. For COLMAP, writes the pinhole images of a key stereo rig.
  void add(const FramePrefetcher::Frame& frame, const FrameResult& result, const StereoOdometry& odometry);
  /// Moves everything to the corrected poses of the frames.
  void correct(const Map& map);
  /// Writes what has been collected; nothing before the first key stereo rig. \throws DataError.
  void write();
  /// What was written; nothing if no map is requested.
  std::optional<report::MapFacts> facts() const { return facts_; }

 private:
  MapFiles files_;
  std::unique_ptr<EdgeMap> map_;  ///< null if no map is requested
  StereoRig rig_;
  std::optional<report::MapFacts> facts_;
};

}  // namespace quadedge::cli
