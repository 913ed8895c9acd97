#include "cli/rendering_status.hpp"

namespace quadedge::cli {

bool RenderingStatus::show(const data::RenderingProgress& frames) {
  if (!progress_) progress_.emplace(quiet_, "frames");
  if (frames.rendered > 0) progress_->update("rendering", frames.ready, frames.frames);
  return interruption_ == nullptr || interruption_->signal() == 0;
}

}  // namespace quadedge::cli
