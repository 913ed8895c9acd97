#pragma once
/// \file rendering_status.hpp  What the user sees of rendering ahead.

#include <optional>

#include "cli/console.hpp"
#include "cli/interruption.hpp"
#include "data/rendered_frames.hpp"

namespace quadedge::cli {

/// "rendering 12/60 ..." while frames are rendered; silent while they are read.
class RenderingStatus {
 public:
  /// `interruption` may be null; else its signal ends the rendering.
  RenderingStatus(bool quiet, const Interruption* interruption) : quiet_(quiet), interruption_(interruption) {}
  /// Returns false after a signal.
  bool show(const data::RenderedFrames& frames);

 private:
  bool quiet_;
  const Interruption* interruption_;
  std::optional<Progress> progress_;  ///< its time begins with the first frame
};

}  // namespace quadedge::cli
