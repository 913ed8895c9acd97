#include "cli/source_options.hpp"

#include "quadedge/error.hpp"

namespace quadedge::cli {

void SourceOptions::declare_path(Options& options, const std::string& help, const std::string& name) {
  options.positional(name, path_, help + "; -: pictures from a pipe", false);
}

void SourceOptions::declare(Options& options) {
  options.group("A camera of your own (doc/your-own-data.md)");
  options.text("--left", own_.left, "folder of the left images, or the left video", "A");
  options.text("--right", own_.right, "folder of the right images, or the right video", "B");
  options.text("--video", own_.video, "one video whose pictures hold both views", "FILE");
  options.text("--split", own_.split, "how a picture holds both views: left-right or top-bottom", "WORD");
  options.text("--calibration", own_.calibration,
               "calibration of both cameras: Kalibr, OpenCV, ROS, EuRoC, or of `check --write-calibration`; also "
               "instead of the one that belongs to a recorded sequence",
               "FILE[,FILE]");
  options.number("--fps", own_.fps, "pairs per second, for stamps; 0: of names, times.txt, data.csv or the video");
  options.text("--times", own_.times, "stamps of the pairs: seconds, one per line, or EuRoC's data.csv", "FILE");
  options.number("--queue", own_.queue,
                 "pairs from a pipe that wait at most, before the oldest is left out; 0: whoever writes has to wait");
  options.number(
      "--fov", own_.fov,
      "horizontal field of view of the pinhole images that a lens's are turned into [degrees]; 0: the lens's "
      "scale in the middle is kept, up to 120");
  options.text("--mask", own_.mask, "image that is black where no edges are wanted; one, or left and right",
               "FILE[,FILE]");
}

StereoSource SourceOptions::own_camera() const {
  StereoSource source = own_;
  source.pipe = path_ == "-";
  if (!path_.empty() && !source.pipe)
    throw UsageError(path_ +
                     ": a recorded sequence has images of its own; leave out PATH, or --left, --right and --video");
  return source;
}

DatasetOptions SourceOptions::layout(DatasetOptions options) const {
  if (!own_.split.empty() || own_.fps != 0 || !own_.times.empty())
    throw UsageError(path_ +
                     ": a recorded sequence has times of its own; --split, --fps and --times are for --left, "
                     "--right, --video and -");
  options.calibration = own_.calibration;
  options.fov = own_.fov;
  options.mask = own_.mask;
  return options;
}

Dataset SourceOptions::open(const DatasetOptions& options) const {
  if (!is_given()) throw UsageError("nothing to read: expected PATH, or --left, --right and --calibration");
  if (!is_own_camera()) return open_dataset(path_, layout(options));
  StereoSource source = own_camera();
  if (options.format != "auto" || !options.sequence.empty())
    throw UsageError("--format and --sequence are for recorded sequences in a published layout");
  source.first_frame = options.first_frame;
  source.last_frame = options.last_frame;
  return open_stereo_source(source);
}

void SourceOptions::refuse_all() const {
  layout({});
  if (tells_cameras()) throw UsageError("--calibration, --fov and --mask: these images are taken as they are");
}

Dataset SourceOptions::still_pair(const std::string& left, const std::string& right) const {
  StereoSource source = own_;
  source.left = left;
  source.right = right;
  source.fps = 1;  // one pair needs no times
  return open_stereo_source(source);
}

PairOfSource SourceOptions::pair(int number) const {
  if (number < 0) throw UsageError("--frame " + std::to_string(number) + ": expected 0 or more");
  DatasetOptions one;
  one.first_frame = number;
  one.last_frame = number + 1;
  PairOfSource result{open(one), {}};
  FramePrefetcher pairs(result.dataset);
  auto pair = pairs.next();
  if (!pair) throw UsageError("--frame " + std::to_string(number) + ": " + result.dataset.path + " ends before it");
  result.pair = std::move(*pair);
  return result;
}

}  // namespace quadedge::cli
