#pragma once
/// \file frontend.hpp  The front end: from two images to stereo edges and quads (doc/design.md section 1).

#include <memory>
#include <vector>

#include "common/filter_limits.hpp"
#include "edges/frame_edges.hpp"
#include "edges/kept_frame_edges.hpp"
#include "geometry/frame_mask.hpp"
#include "geometry/row_correction.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/device.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/error.hpp"
#include "quadedge/tap.hpp"

namespace quadedge::frontend {

/// Counts of the current frame.
struct FrontendCounts {
  double edge_threshold = 0;       ///< of both images [grey levels per px]
  double disparity_range = 0;      ///< maximum disparity searched in the middle of the left image [px]
  double epipolar_correction = 0;  ///< see RigEvidence
  int edges_left = 0, edges_right = 0;
  int dropped_edges = 0;  ///< beyond edges.max_edges, in both images
};

/// Interface with four implementations: the default and the paper's method, each on OpenCL and in plain C++. Callers
/// keep frames by holding their handles.
class Frontend {
 public:
  virtual ~Frontend() = default;

  /// Stages 1 to 5 of doc/design.md section 1: images to stereo edges. \returns the frame's edges, which are the
  /// current ones until the next call and are then reused unless a handle exists
  virtual FrameEdgesHandle process(const StereoFrame& frame) = 0;
  /// The edges of the frame processed last. \throws std::out_of_range before the first
  virtual FrameEdgesHandle latest() const = 0;
  /// Stage 6: quads between an earlier frame, the base, and a current one, as a rule the latest. `search` has one entry
  /// per stereo edge of the base. Replaces `matches`.
  virtual void match(const FrameEdges& base, const FrameEdges& current, const TemporalSearch& search,
                     TemporalMatches& matches) = 0;
  /// With the latest frame.
  TemporalMatches match(const FrameEdges& base, const TemporalSearch& search) {
    TemporalMatches matches;
    match(base, *latest(), search, matches);
    return matches;
  }

  /// Hides these pixels of the left image, besides those that the rig masks, from the next frame on. An empty mask
  /// hides none.
  void hide(const PixelMask& left);

  /// What the masks of the current frame hide; the rig's own and those of hide() aside.
  const HiddenPixels& hidden_in_frame() const { return of_frame_; }

  /// Corrects the rows of every frame from the next one on. \param rows must outlive the use; null: as calibrated
  void correct_rows(RowCorrection* rows) { rows_ = rows == nullptr ? &as_calibrated_ : rows; }

  /// Whether the current frame is so noisy that its images were smoothed.
  bool is_smoothed() const { return is_smoothed_; }
  /// The images of the current frame in which edges were found: `frame`, or if that is noisy the smoothed images.
  StereoFrame searched(const StereoFrame& frame) const {
    return is_smoothed_ ? StereoFrame{frame.stamp_ns, smoothed_left_.view(), smoothed_right_.view()} : frame;
  }

  const FrontendCounts& counts() const { return counts_; }

  /// Edges of one of the current images.
  virtual EdgeSet edges(Side side) = 0;
  virtual std::size_t device_bytes() const = 0;

  /// Observes every filter from now on; null stops.
  void set_tap(Tap* tap) { tap_ = tap; }

 protected:
  Frontend(const StereoRig& rig, const Config& config)
      : calibration_(rig),
        masks_{rig.left_mask, rig.right_mask},
        left_mask_of_rig_(rig.left_mask),
        margin_(config.edges.margin) {}
  /// Takes the masks that come with a frame, before edges are found in it. \returns FrameEdges::hidden
  std::shared_ptr<const PixelMask> take_masks(const StereoFrame& frame);
  RowCorrection& rows() const { return *rows_; }
  /// Called when masks_ have changed.
  virtual void masks_changed() {}

  StereoRig calibration_;
  HiddenPixels masks_;  ///< of the current frame: what the rig masks, what hide() was given, and the frame's own
  FrontendCounts counts_;
  bool is_smoothed_ = false;              ///< the current frame
  Image smoothed_left_, smoothed_right_;  ///< as recorded, if it is
  int searches_ = 0;  ///< calls of match() for the current frame; they number TemporalMatches::search
  Tap* tap_ = nullptr;

 private:
  RowCorrection as_calibrated_;
  RowCorrection* rows_ = &as_calibrated_;
  PixelMask left_mask_of_rig_;
  int margin_;
  HiddenPixels of_frame_;
  MaskTransfer to_left_, to_right_;
};

/// A front end that also matches over the whole image, and keeps frames as later bases: any but the paper's.
class GlobalFrontend : public Frontend {
 public:
  /// Quads between a subset of the base's edges and the current frame, matched over the whole left image by wide
  /// descriptors.
  /// \param edges approximate number of the base's edges and, twice as many, of the current frame's that take part;
  /// ignored for a restored frame, which has its own
  virtual void match_globally(const FrameEdges& base, const FrameEdges& current, int edges,
                              TemporalMatches& matches) = 0;
  /// The same among the given edges only. For a restored base, of_base is ignored: all its edges take part.
  virtual void match_globally(const FrameEdges& base, const FrameEdges& current, const GlobalSearch& among,
                              TemporalMatches& matches) = 0;
  TemporalMatches match_globally(const FrameEdges& base, int edges) {
    TemporalMatches matches;
    match_globally(base, *latest(), edges, matches);
    return matches;
  }
  /// Keeps the latest frame's edges in a compact form.
  virtual KeptFrameEdges keep() = 0;
  /// Restores kept frame edges as a base of match() and match_globally().
  virtual FrameEdgesHandle restore(const KeptFrameEdges& kept) = 0;

 protected:
  using Frontend::Frontend;
};

/// \throws std::bad_cast for the paper's front end
inline GlobalFrontend& as_global(Frontend& frontend) { return dynamic_cast<GlobalFrontend&>(frontend); }

/// Creates the front end of the paper's method if `config` asks for it, else the OpenCL front end on `device`, or the
/// reference if `device` is the reference.
/// \throws UsageError for an unknown variant or invalid limits; DeviceError if kernels do not build
/// \param warnings receives warnings about the device; null: discarded
std::unique_ptr<Frontend> make_frontend(const StereoRig& rig, Device& device, const Config& config,
                                        std::vector<Warning>* warnings = nullptr);

}  // namespace quadedge::frontend
