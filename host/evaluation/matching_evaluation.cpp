#include "evaluation/matching_evaluation.hpp"

#include <algorithm>

#include "common/disparity_range.hpp"
#include "evaluation/matching_observer.hpp"
#include "quadedge/error.hpp"

namespace quadedge::evaluation {

MatchingResult evaluate_matching(const MatchingSource& source, Device& device, Config config,
                                 const MatchingOptions& options) {
  if (device.is_reference())
    throw UsageError("evaluate matching needs an OpenCL device, because the reference has no taps");
  config.odometry.key_rig = false;  // the tables refer to consecutive frames
  MatchingObserver observer(source.rig(), with_disparity_range(config, source.rig()), options.tolerance,
                            options.distributions);
  StereoOdometry odometry(source.rig(), device, config);
  odometry.set_tap(&observer);
  MatchingResult result;
  result.name = source.name();
  const int count = options.frames > 0 ? std::min(options.frames, source.frames()) : source.frames();
  const int drawn = std::min(options.draw_frame, count - 1);
  for (int number = 0; number < count; ++number) {
    TrueFrame frame = source.load(number);
    observer.begin(number, std::move(frame.truth));
    FrameMatching measured = observer.end(odometry.track(frame.frame.view()));
    add(result.cues, measured.cues);
    measured.cues = {};
    result.frames.push_back(std::move(measured));
    if (number == drawn) {
      result.drawn =
          DrawnFrame{number, std::move(frame.frame.left), std::move(frame.frame.right), observer.final_matches()};
    }
    if (options.progress) options.progress(number + 1, count);
  }
  return result;
}

}  // namespace quadedge::evaluation
