#pragma once
/// \file sequence_run.hpp  Tracks a whole sequence and writes its output folder; shared by `run` and `demo`.

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>

#include "cli/frame_source.hpp"
#include "cli/method_options.hpp"
#include "cli/points_output.hpp"
#include "cli/processes.hpp"
#include "output/run_record.hpp"
#include "quadedge/drive_calibration.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {

/// How to run a sequence.
struct SequenceRunOptions {
  std::string output;  ///< folder
  bool quiet = false, force = false;
  bool restarts = false;  ///< a stamp that goes back starts a segment
  /// Drawings of edges and quads: of every `draw_every`-th frame (0: none), or of `draw_frame` alone (-1: none).
  int draw_every = 0;
  int draw_frame = -1;
  PointFiles points;
  std::string saved_map;                    ///< file for the places of the recording, which need `loops`; empty: none
  bool loops = false;                       ///< recognise places, and write the corrected trajectory and the closures
  std::optional<DriveCalibration> learned;  ///< what the rig was learned to be, if it was; written beside the results
  int thumbnails = 0;  ///< number of quad thumbnails, spread evenly over the frames after the first
};

/// Tracks all frames, writing every finished one at once, then the accuracy, the pictures and the report. After a
/// signal or an error (of the recording, or of the device) these are written for the frames so far: a signal then
/// prints them and ends the process, an error is thrown on. \throws Error.
report::RunRecord run_sequence(FrameSource& source, const MethodOptions& method, const SequenceRunOptions& options,
                               const Interruption& interruption);

/// Exit code of a finished run: too_few_tracked below `min_tracked` percent (with a message on stderr), else done.
int exit_code(const report::RunRecord& run, double min_tracked);
/// The same for `done` frames of all. `verb`: what was done with them, for the message; `lost`: why others were not.
int exit_code(const char* verb, int done, std::size_t frames, double min_tracked, const std::string& lost);

/// A run ended with `error` after some frames: calls each of `parts`, which write what is finished, and ignores that a
/// disk is full. \throws Error with its exit code, what happened and where the frames are.
[[noreturn]] void end_with_error(const Error& error, std::size_t frames, const std::string& folder,
                                 std::initializer_list<std::function<void()>> parts);

}  // namespace quadedge::cli
