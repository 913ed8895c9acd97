/// \file stereo_source.cpp  Opens image folders, videos and pipes as datasets.
#include "quadedge/stereo_source.hpp"

#include <algorithm>
#include <cmath>
#include <unistd.h>

#include "common/printed.hpp"
#include "data/calibrations/forms.hpp"
#include "data/find_sequences.hpp"
#include "data/image_list.hpp"
#include "data/layout.hpp"
#include "data/stream_reader.hpp"
#include "data/text.hpp"
#include "data/video_file.hpp"
#include "quadedge/error.hpp"

namespace quadedge {
namespace data {
namespace {

constexpr double kNanoseconds = 1e9;  // per second
constexpr int kLiveQueue = 4;         // pairs that wait at most: a fifth of a second at 20 Hz
constexpr double kSameRate = 0.05;    // relative difference up to which two rates agree

std::int64_t stamp_at(int number, double fps) { return std::llround(number / fps * kNanoseconds); }

/// Keeps the images of both cameras that are nearest in time. \returns a warning if some are dropped
/// \throws DataError if most of the images would be
std::string keep_pairs(const StereoSource& source, CameraImages& left, CameraImages& right) {
  constexpr double kNanosecondsPerMillisecond = 1e6;
  const std::size_t lefts = left.files.size(), rights = right.files.size();
  const StampPairs found =
      pair_stamps(left.stamps_ns, right.stamps_ns, std::llround(source.tolerance_ms * kNanosecondsPerMillisecond));
  const std::size_t pairs = found.pairs.size();
  if (2 * pairs < std::max(lefts, rights)) {
    fail(source.right,
         counted(rights, "image") + " of which " + std::to_string(pairs) + " are as old as one of the " +
             std::to_string(lefts) + " in " + source.left + " (" + right.stamps_from + " from " +
             format_seconds(right.stamps_ns.front()) + ", " + left.stamps_from + " from " +
             format_seconds(left.stamps_ns.front()) + ")",
         "timestamps of one clock, or --times FILE");
  }
  CameraImages kept_left{{}, {}, left.stamps_from}, kept_right{{}, {}, right.stamps_from};
  for (const auto& [l, r] : found.pairs) {
    kept_left.files.push_back(left.files[l]);
    kept_left.stamps_ns.push_back(left.stamps_ns[l]);
    kept_right.files.push_back(right.files[r]);
    kept_right.stamps_ns.push_back(right.stamps_ns[r]);
  }
  left = std::move(kept_left);
  right = std::move(kept_right);
  if (pairs == lefts && pairs == rights) return {};
  return std::to_string(lefts - pairs) + " left and " + std::to_string(rights - pairs) +
         " right images without a counterpart are dropped; the timestamps of a pair differ by up to " +
         format_fixed(static_cast<double>(found.largest_difference_ns) / kNanosecondsPerMillisecond, 3) + " ms";
}

void check_count(const std::string& shorter_or_equal, std::size_t found, const std::string& what, std::size_t expected,
                 const std::string& other) {
  if (found == expected) return;
  fail(shorter_or_equal, std::to_string(found) + " " + what, "the " + std::to_string(expected) + " of " + other);
}

/// A warning if `fps` differs from the rate of the timestamps, which are used nevertheless; otherwise empty.
std::string rate_warning(double fps, const CameraImages& images) {
  const std::int64_t period = usual_period(images.stamps_ns);
  const double rate = period > 0 ? kNanoseconds / static_cast<double>(period) : 0;
  if (!(fps > 0 && rate > 0) || std::abs(fps - rate) <= kSameRate * rate) return {};
  return printed("--fps %g contradicts the timestamps, whose rate is %.4g Hz; ", fps, rate) +
         ("those of " + images.stamps_from) + " are used, unless --times FILE replaces them";
}

/// The timestamps of the pairs: those of --times, otherwise of the images, otherwise of --fps.
/// \throws DataError if there are none
std::vector<std::int64_t> stamps_of_images(const StereoSource& source, const CameraImages& left,
                                           const CameraImages& right, std::vector<std::string>& warnings) {
  const std::size_t pairs = left.files.size();
  if (!source.times.empty()) {
    const auto stamps = read_times(source.times, source.restarts);
    check_count(source.times, stamps.size(), "times", pairs, source.left);
    return stamps;
  }
  const CameraImages& stamped = left.stamps_ns.empty() ? right : left;
  if (!stamped.stamps_ns.empty()) {
    const std::string warning = rate_warning(source.fps, stamped);
    if (!warning.empty()) warnings.push_back(warning);
    return stamped.stamps_ns;
  }
  if (const std::string jump = number_jump(left.files); !jump.empty()) warnings.push_back(jump);
  std::vector<std::int64_t> stamps;
  for (std::size_t i = 0; source.fps > 0 && i < pairs; ++i) stamps.push_back(stamp_at(static_cast<int>(i), source.fps));
  if (stamps.empty()) {
    fail(source.left,
         "images whose names are not timestamps, such as " + fs::path(left.files.front()).filename().string(),
         "--fps N, --times FILE, or a times.txt or data.csv beside them");
  }
  return stamps;
}

/// The images of a folder, or a single image file.
CameraImages images_of(const std::string& place, bool needs_stamps) {
  if (fs::is_directory(place)) return list_images(place, needs_stamps);
  return {{place}, {}, {}};
}

/// The images of both cameras. Times beside them that cannot be read matter only where --fps does not replace them.
std::pair<CameraImages, CameraImages> images_of_both(const StereoSource& source, Dataset& dataset) {
  const auto list = [&](bool needs_stamps) {
    return std::pair(images_of(source.left, needs_stamps), images_of(source.right, needs_stamps));
  };
  try {
    return list(source.times.empty());
  } catch (const DataError& problem) {
    if (!(source.fps > 0)) throw;
    auto images = list(false);
    dataset.warnings.push_back(problem.what() + std::string("; --fps is used instead"));
    return images;
  }
}

Dataset open_images(const StereoSource& source, Findings& findings) {
  Dataset dataset;
  auto [left, right] = images_of_both(source, dataset);
  if (!left.stamps_ns.empty() && !right.stamps_ns.empty())
    if (const std::string dropped = keep_pairs(source, left, right); !dropped.empty())
      dataset.warnings.push_back(dropped);
  if (left.files.size() > right.files.size()) {
    check_count(source.right, right.files.size(), "images", left.files.size(), source.left);
  }
  check_count(source.left, left.files.size(), "images", right.files.size(), source.right);
  const auto stamps = stamps_of_images(source, left, right, dataset.warnings);
  dataset.format = "images";
  dataset.path = source.left;
  dataset.name = source_name(source);
  for (std::size_t i = 0; i < left.files.size(); ++i)
    add_frame(dataset, stamps[i], left.files[i], right.files[i], findings);
  return dataset;
}

/// Sets the rig for images of these sizes. \throws DataError if the calibration is for other sizes
void set_rig(const StereoSource& source, ImageSize left, ImageSize right, const std::string& images, Dataset& dataset) {
  dataset.calibration = read_calibration(source.calibration, source.rectified);
  set_image_sizes(*dataset.calibration, left, right, images);
  dataset.rig = make_rig(*dataset.calibration, source.fov);
  if (!source.mask.empty()) mask_rig(dataset.rig, source.mask);
  dataset.rig.max_value = left.max_value;
}

/// Number of pairs according to the videos' headers; 0 if unknown. \throws DataError if the videos differ
int promised_pairs(const Video& left, const Video& right) {
  const bool right_is_short = right.promised < left.promised;
  const Video &shorter = right_is_short ? right : left, &longer = right_is_short ? left : right;
  if (shorter.promised > 0 && longer.promised - shorter.promised > 1) {  // a duration may be that of one frame less
    fail(shorter.file, counted(shorter.promised, "frame"),
         "the " + std::to_string(longer.promised) + " of " + longer.file);
  }
  return shorter.promised;
}

/// Opens the stream and looks at its first pair.
Dataset open_stream(const StereoSource& source, const StreamOptions& options) {
  Dataset dataset;
  std::shared_ptr<StreamOfReaders> stream;
  if (source.pipe) {
    dataset.format = dataset.name = "pipe";
    dataset.path = "standard input";
    stream = make_picture_pipe(STDIN_FILENO, options);
    for (std::size_t i = 0; i < options.stamps_ns.size(); ++i) {
      const std::string number = " image " + std::to_string(i);
      dataset.frames.push_back({0, dataset.path + ", left" + number, dataset.path + ", right" + number});
    }
  } else {
    const Video left = describe_video(source.video.empty() ? source.left : source.video);
    std::optional<Video> right;
    if (!source.right.empty()) right = describe_video(source.right);
    dataset.format = "video";
    dataset.path = left.file;
    dataset.name = source_name(source);
    stream = make_video_stream(left, right, options);
    const int pairs = promised_pairs(left, right.value_or(left));
    const double fps = source.fps > 0 ? source.fps : left.fps;
    if (!source.times.empty() && pairs > 0)
      check_count(source.times, options.stamps_ns.size(), "times", static_cast<std::size_t>(pairs), left.file);
    for (int i = 0; fps > 0 && i < pairs; ++i)
      dataset.frames.push_back({stamp_at(i, fps), left.file, right.value_or(left).file});
  }
  for (std::size_t i = 0; i < std::min(dataset.frames.size(), options.stamps_ns.size()); ++i)
    dataset.frames[i].stamp_ns = options.stamps_ns[i];
  const StereoPair first = stream->look(dataset.path);
  set_rig(source, size_of(first.left), size_of(first.right), dataset.path, dataset);
  dataset.stream = stream;
  return dataset;
}

void check_source(const StereoSource& source) {
  const bool two = !source.left.empty() || !source.right.empty(), one = !source.video.empty();
  if (two + one + source.pipe != 1) throw UsageError("expected one of --left A with --right B, --video F, and -");
  if (two && (source.left.empty() || source.right.empty())) throw UsageError("--left and --right go together");
  if (source.calibration.empty())
    throw UsageError("give the calibration of both cameras with --calibration FILE (doc/your-own-data.md)");
  parse_split(source.split);
  if (one && source.split.empty()) throw UsageError("--video needs --split left-right or --split top-bottom");
  if (two && !source.split.empty()) throw UsageError("--split is for --video and -, whose images contain both views");
  if (!(source.fps >= 0 && std::isfinite(source.fps)))
    throw UsageError("--fps: expected frames per second, more than 0");
  if (source.fps > 0 && !source.times.empty()) throw UsageError("--fps and --times exclude one another");
  if (source.pipe && source.fps == 0 && source.times.empty())
    throw UsageError("images in a pipe have no timestamps: give --fps N or --times FILE");
  if (!(source.tolerance_ms >= 0 && std::isfinite(source.tolerance_ms)))
    throw UsageError("--tolerance: expected milliseconds, 0 or more");
  if (source.live && !source.pipe) throw UsageError("--live applies to a pipe (-) only; files are read whole");
}

/// \throws DataError for files and folders that do not exist, and for a folder beside a file.
void check_places(const StereoSource& source) {
  for (const auto* place : {&source.left, &source.right, &source.video}) {
    if (place->empty() || fs::exists(*place)) continue;
    fail(*place, "no such file or folder",
         place == &source.video ? "a video" : "a folder of images, an image or a video");
  }
  if (source.left.empty() || fs::is_directory(source.left) == fs::is_directory(source.right)) return;
  const bool left_is_folder = fs::is_directory(source.left);
  fail(source.right, left_is_folder ? "a file" : "a folder",
       (left_is_folder ? "a folder as " : "a file as ") + source.left + " is");
}

Dataset read_source(const StereoSource& source, Findings& findings) {
  check_source(source);
  check_places(source);
  const auto holds_images = [](const std::string& place) { return fs::is_directory(place) || is_image_name(place); };
  const bool are_files = !source.left.empty() && holds_images(source.left) && holds_images(source.right);
  Dataset dataset;
  if (are_files) {
    dataset = open_images(source, findings);
    const FrameFiles& first = dataset.frames.front();
    set_rig(source, image_size(first.left), image_size(first.right), first.left + ", " + first.right, dataset);
  } else {
    StreamOptions options{parse_split(source.split),
                          source.fps,
                          source.live ? kLiveQueue : 0,
                          source.first_frame,
                          source.last_frame,
                          {},
                          source.times};
    if (!source.times.empty()) options.stamps_ns = read_times(source.times, source.restarts);
    dataset = open_stream(source, options);
  }
  dataset.restarts = source.restarts;
  finish_dataset(dataset, source.first_frame, source.last_frame, findings);
  return dataset;
}

}  // namespace
}  // namespace data

Dataset open_stereo_source(const StereoSource& source) {
  data::Findings findings(false);
  try {
    return data::read_source(source, findings);
  } catch (const std::filesystem::filesystem_error& problem) {
    throw DataError(data::unreadable_place(problem.path1().string(), problem));
  }
}

DatasetCheck check_stereo_source(const StereoSource& source,
                                 const std::function<void(const Dataset&, const StereoPair&)>& seen) {
  StereoSource waiting = source;
  waiting.live = false;  // no pair may be dropped
  return data::check_opened(
      "", [&](data::Findings& findings) { return data::read_source(waiting, findings); }, seen);
}

}  // namespace quadedge
