#pragma once
/// \file matching_source.hpp  Pairs and sequences with the ground truth of every frame.

#include <memory>
#include <string>
#include <vector>

#include "evaluation/edge_truth.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/synthetic.hpp"

namespace quadedge::evaluation {

/// One frame with its truth.
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
  virtual double max_disparity() const = 0;  ///< px
  virtual int frames() const = 0;
  /// \throws DataError for a file that cannot be read.
  virtual TrueFrame load(int number) const = 0;
};

/// A data set whose frames have disparities, or depths and poses (the layout that `synth` writes).
/// \throws DataError when it has neither, or lenses are distorted.
std::unique_ptr<MatchingSource> make_recorded_source(const Dataset& dataset);

/// A rendered scene.
std::unique_ptr<MatchingSource> make_rendered_source(const SyntheticOptions& options);

/// Has the data set what make_recorded_source needs?
bool has_matching_truth(const Dataset& dataset);

/// The data set at `path`, or all data sets with truth in the folders below it (two levels), by name. Sets without
/// truth are named in `skipped`. \throws DataError when there is none with truth.
std::vector<Dataset> find_true_datasets(const std::string& path, std::vector<std::string>& skipped);

}  // namespace quadedge::evaluation
