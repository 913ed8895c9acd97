/// \file command_match.cpp  quadedge edges and match: third-order edges of one image, stereo edges of one pair.
#include <cstdio>

#include "cli/command.hpp"
#include "cli/console.hpp"
#include "cli/method_options.hpp"
#include "cli/source_options.hpp"
#include "data/atomic_file.hpp"
#include "data/text.hpp"
#include "geometry/undistortion.hpp"
#include "output/drawing.hpp"
#include "output/output_folder.hpp"
#include "output/result_rows.hpp"
#include "output/statistics.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/error.hpp"
#include "quadedge/match_stereo.hpp"

namespace quadedge::cli {
namespace {

/// A pair and its cameras.
struct Pair {
  Image left, right;
  StereoRig rig;
  bool is_calibrated = false;
};

/// A command for one image or pair.
class SingleCommand : public Command {
 protected:
  using Command::Command;

  void declare_rest(Options& options) {
    options.flag("--force", force_, "overwrite existing files");
    options.flag("--quiet", quiet_, "hide the summary");
    method_.declare(options);
  }

  std::string csv_, draw_;
  bool force_ = false, quiet_ = false;
  MethodOptions method_;
};

class EdgesCommand : public SingleCommand {
 public:
  EdgesCommand()
      : SingleCommand("edges", "detect the third-order edges of one image",
                      "  quadedge edges image.png --csv edges.csv --draw edges.png\n"
                      "  quadedge edges image.png --edges.threshold 4 --csv strong.csv") {}
  void declare(Options& options) override {
    options.positional("IMAGE", image_, "image file; colour is converted to grey");
    options.output("--csv", csv_, "write x, y, direction_rad and strength of every edge");
    options.output("--draw", draw_, "draw the edges to a PNG file");
    declare_rest(options);
  }
  int run() override {
    const Config config = method_.config();
    report::check_output_file(csv_, force_);
    report::check_output_file(draw_, force_);
    const Image image = read_grey_image(image_);
    Device device = method_.open_device();
    const EdgeSet edges = detect(image, device, config);
    if (!csv_.empty()) data::write_atomically(csv_, report::edges_csv(edges));
    if (!draw_.empty()) report::draw_edges(draw_, image.view(), edges);
    if (!quiet_) {
      const std::vector<double> strengths(edges.strength.begin(), edges.strength.end());
      std::printf("image      %s, %d x %d\ndevice     %s\nedges      %zu", image_.c_str(), image.width, image.height,
                  device.info().name.c_str(), edges.size());
      if (!strengths.empty()) std::printf(", median strength %.2f grey levels per pixel", report::median(strengths));
      std::printf("\n");
    }
    return 0;
  }

 private:
  /// \throws an error that names the image.
  EdgeSet detect(const Image& image, Device& device, const Config& config) const {
    try {
      return detect_edges(image.view(), device, config);
    } catch (const Error& error) {
      throw Error(error.exit_code(), image_ + ": " + error.what());
    }
  }

  std::string image_;
};

class MatchCommand : public SingleCommand {
 public:
  MatchCommand()
      : SingleCommand(
            "match", "match the edges of one stereo pair",
            "  quadedge match left.png right.png --stereo.max_disparity 96 --csv matches.csv --draw matches.png\n"
            "  quadedge match left.png right.png --calibration camchain.yaml --ply points.ply") {}
  void declare(Options& options) override {
    options.positional("LEFT", left_, "left image file; without --calibration both images must be rectified");
    options.positional("RIGHT", right_, "right image file");
    options.output("--csv", csv_,
                   "write positions and directions in both images, NCC and 3D point of every stereo edge");
    options.output("--ply", ply_, "write the 3D points as a binary PLY file; needs --calibration");
    options.output("--draw", draw_, "draw the stereo edges to a PNG file");
    options.group("Cameras (doc/your-own-data.md)");
    source_.declare_cameras(options);
    declare_rest(options);
  }
  int run() override {
    const Config config = method_.config();
    for (const auto& file : {csv_, ply_, draw_}) report::check_output_file(file, force_);
    const Pair pair = read_pair();
    if (!ply_.empty() && !pair.is_calibrated) throw UsageError("--ply needs --calibration");
    Device device = method_.open_device();
    const StereoMatches matches = match_stereo({0, pair.left.view(), pair.right.view()}, pair.rig, device, config);
    for (const Warning& warning : matches.warnings) note("warning: " + warning.text);
    if (!csv_.empty()) data::write_atomically(csv_, report::matches_csv(matches, pair.is_calibrated));
    if (!ply_.empty()) write_ply(ply_, points(matches));
    if (!draw_.empty()) draw(pair, matches);
    if (!quiet_) print(device, matches, pair.is_calibrated);
    return 0;
  }

 private:
  Pair read_pair() const {
    Pair pair;
    if (source_.has_calibration()) {
      Dataset dataset = source_.still_pair(left_, right_);
      return {read_grey_image(left_), read_grey_image(right_), std::move(dataset.rig), true};
    }
    if (source_.has_camera_options()) throw UsageError("--fov and --mask need --calibration");
    pair.left = read_grey_image(left_);
    pair.right = read_grey_image(right_);
    if (pair.left.max_value != pair.right.max_value || pair.left.height != pair.right.height)
      throw DataError(right_ + ": found " + data::counted(pair.right.height, "row") + " and values to " +
                      std::to_string(pair.right.max_value) + ", expected " + std::to_string(pair.left.height) +
                      " and " + std::to_string(pair.left.max_value) + " as in " + left_);
    pair.rig = rectified_images(pair.left.width, pair.left.height, pair.right.width, pair.right.height);
    pair.rig.max_value = pair.left.max_value;
    return pair;
  }

  static std::vector<CloudPoint> points(const StereoMatches& matches) {
    std::vector<CloudPoint> found;
    for (const auto& point : matches.points)
      if (point) found.push_back(*point);
    return found;
  }

  void draw(const Pair& pair, const StereoMatches& matches) const {
    const auto& table = matches.rig.left_undistortion;
    const Image left = table.empty() ? pair.left : undistort(pair.left.view(), table);
    report::draw_stereo(draw_, left.view(), matches.edges);
  }

  static void print(const Device& device, const StereoMatches& matches, bool is_calibrated) {
    std::printf("device        %s\nedges         %zu in the left image\nstereo edges  %zu", device.info().name.c_str(),
                matches.left_edges.size(), matches.edges.size());
    std::vector<double> depths;
    for (const auto& point : points(matches)) depths.push_back(point.position.z());
    if (is_calibrated && !depths.empty()) std::printf(", median depth %.2f m", report::median(depths));
    std::printf("\n");
  }

  std::string left_, right_, ply_;
  SourceOptions source_;
};

}  // namespace

std::unique_ptr<Command> make_edges_command() { return std::make_unique<EdgesCommand>(); }
std::unique_ptr<Command> make_match_command() { return std::make_unique<MatchCommand>(); }

}  // namespace quadedge::cli
