#pragma once
/// \file matching_source.hpp  Pairs and sequences with ground truth of every frame.

#include <memory>
#include <string>
#include <vector>

#include "evaluation/edge_truth.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/synthetic.hpp"

namespace quadedge::evaluation {

/// One frame with its ground truth.
struct TrueFrame {
  FramePrefetcher::Frame frame;
  FrameTruth truth;
};

/// A pair or a sequence.
class MatchingSource {
 public:
  virtual ~MatchingSource() = default;
  virtual std::string name() const = 0;
  virtual const StereoRig& rig() const = 0;
  virtual int frames() const = 0;
  /// \throws DataError for a file that cannot be read.
  virtual TrueFrame load(int number) const = 0;
};

/// A dataset whose frames have disparities, or depths and poses (the layout written by `synth`).
/// \throws DataError if it has neither, or if its images are distorted
std::unique_ptr<MatchingSource> make_recorded_source(const Dataset& dataset);

/// A rendered scene.
std::unique_ptr<MatchingSource> make_rendered_source(const SyntheticOptions& options);

/// Whether a dataset has the ground truth that make_recorded_source() needs.
bool has_matching_truth(const Dataset& dataset);

/// The dataset at `path`, or all datasets with ground truth in the folders below it, sorted by path.
/// Those without ground truth and damaged ones are listed in `skipped`, with the reason. \throws DataError if none has
/// ground truth
std::vector<Dataset> find_true_datasets(const std::string& path, std::vector<std::string>& skipped);

}  // namespace quadedge::evaluation
