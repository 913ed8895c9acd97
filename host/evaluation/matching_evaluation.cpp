#include "evaluation/matching_evaluation.hpp"

#include <algorithm>

#include "evaluation/matching_observer.hpp"
#include "quadedge/error.hpp"

namespace quadedge::evaluation {

MatchingResult evaluate_matching(const MatchingSource& source, Device& device, Config config, int frames,
                                 const MatchingTolerance& tolerance, const std::function<void(int, int)>& progress) {
  if (device.is_reference()) throw UsageError("the filters are observed on an OpenCL device; the reference shows its results only");
  if (config.stereo.max_disparity == 0 && config.stereo.min_depth == 0) config.stereo.max_disparity = source.max_disparity();
  MatchingObserver observer(source.rig(), config, tolerance);
  StereoOdometry odometry(source.rig(), device, config);
  odometry.set_tap(&observer);
  MatchingResult result{source.name(), {}};
  const int count = frames > 0 ? std::min(frames, source.frames()) : source.frames();
  for (int number = 0; number < count; ++number) {
    TrueFrame frame = source.load(number);
    observer.begin(std::move(frame.truth));
    result.frames.push_back(
        observer.end(odometry.track({frame.frame.stamp_ns, frame.frame.left.view(), frame.frame.right.view()})));
    if (progress) progress(number + 1, count);
  }
  return result;
}

}  // namespace quadedge::evaluation
