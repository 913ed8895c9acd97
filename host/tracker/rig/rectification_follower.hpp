#pragma once
/// \file rectification_follower.hpp  The rectification error that the stereo search corrects. doc/method.md section 3.

#include <vector>

#include "geometry/row_correction.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "rig/row_model.hpp"

namespace quadedge::rig {

/// Follows the rectification error that the rig monitor measures from frame to frame. Before the first frame is taken,
/// frames are measured on their own stereo edges and searched again if the error matters. Depends only on the rig and
/// on the frames taken.
class RectificationFollower : public RowCorrection {
 public:
  /// \param rig must outlive the object
  RectificationFollower(const StereoRig& rig, const StereoConfig& config);

  void start_frame() override;
  bool suffices(const StereoFrame& frame, const StereoEdges& edges) override;
  const RectificationError& error() const override { return error_; }
  /// Takes the matches of the current frame into account. A frame that is not taken leaves no trace. \returns by how
  /// much the rows have changed, if some frames in a row contradict the earlier ones, which are then forgotten [px]
  double observe(const std::vector<CornerMatch>& matches);
  /// Whether the frame last observed contradicted the earlier ones: its rows are not those of the known rig.
  bool is_contradicted() const { return is_contradicted_; }

 private:
  bool contradicts(const std::vector<CornerMatch>& matches);
  /// What a model says, limited, or zero if it is small.
  RectificationError judge(const RowModel& rows) const;

  const StereoRig& rig_;
  double least_;                     ///< no smaller error is corrected [px]
  RectificationError error_, next_;  ///< of the current frame, and of the next one
  RowModel rows_;                    ///< of the frames taken
  RowModel changed_;                 ///< of the last ones, which contradict the others
  bool is_contradicted_ = false;     ///< by the last frame
  bool is_settled_ = false;          ///< whether a frame has been taken
  bool is_second_search_ = false;
};

}  // namespace quadedge::rig
