#pragma once
/// \file map_output.hpp  The map that a run leaves behind.

#include <memory>
#include <optional>
#include <string>

#include "cli/command.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/edge_map.hpp"
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
  /// Before long work. \throws UsageError, DataError for what could not be written, or exists without `force`.
  void check(bool force) const;
};

/// Collects the map of a run and writes it in the end; does nothing where none is wanted.
class MapOutput {
 public:
  MapOutput(const MapFiles& files, const Config& config);
  /// Takes in the frame that was tracked last. For COLMAP, writes the pinhole images of a key stereo rig.
  void add(const FramePrefetcher::Frame& frame, const FrameResult& result, const StereoOdometry& odometry);
  /// Writes what has been collected; nothing before the first key stereo rig. \throws DataError.
  void write();
  /// What was written; nothing where no map is wanted.
  std::optional<report::MapFacts> facts() const { return facts_; }

 private:
  MapFiles files_;
  std::unique_ptr<EdgeMap> map_;  ///< null where none is wanted
  StereoRig rig_;
  std::optional<report::MapFacts> facts_;
};

}  // namespace quadedge::cli
