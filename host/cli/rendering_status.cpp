#include "cli/rendering_status.hpp"

namespace quadedge::cli {

bool RenderingStatus::show(const data::RenderedFrames& frames) {
  if (!progress_) progress_.emplace(quiet_, "frames");
  if (frames.rendered() > 0) progress_->update("rendering", frames.ready(), frames.sequence().frames());
  return interruption_ == nullptr || interruption_->signal() == 0;
}

}  // namespace quadedge::cli
