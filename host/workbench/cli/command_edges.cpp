/// \file command_edges.cpp  quadedge edges: third-order edges of one image.
#include <cstdio>

#include "cli/command.hpp"
#include "cli/method_options.hpp"
#include "cli/source_options.hpp"
#include "data/atomic_file.hpp"
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

class EdgesCommand : public Command {
 public:
  EdgesCommand()
      : Command("edges", "detect the third-order edges of one image, or of a left image of your own cameras",
                "  quadedge edges image.png --csv edges.csv --draw edges.png\n"
                "  quadedge edges image.png --edges.threshold 4 --csv strong.csv") {}
  void declare(Options& options) override {
    source_.declare_path(options, "image file; colour is converted to grey", "IMAGE");
    options.number("--frame", frame_,
                   "with --left and --right, --video or -: number of the pair, from 0; its left pinhole image is used");
    options.output("--csv", csv_, "write x, y, direction_rad and strength of every edge");
    options.output("--draw", draw_, "draw the edges to a PNG file");
    options.flag("--force", force_, "overwrite existing files");
    options.flag("--quiet", quiet_, "hide the summary");
    source_.declare(options);
    method_.declare(options);
  }
  int run() override {
    const Config config = method_.config();
    report::check_output_file(csv_, force_);
    report::check_output_file(draw_, force_);
    if (!source_.is_given()) throw UsageError("nothing to read: expected IMAGE, or --left, --right and --calibration");
    if (!source_.is_own_camera()) source_.refuse_all();
    const Image image = source_.is_own_camera() ? left_image() : read_grey_image(source_.path());
    Device device = method_.open_device();
    const EdgeSet edges = detect(image, device, config);
    if (!csv_.empty()) data::write_atomically(csv_, report::edges_csv(edges));
    if (!draw_.empty()) report::draw_edges(draw_, image.view(), edges);
    if (!quiet_) {
      const std::vector<double> strengths(edges.strength.begin(), edges.strength.end());
      std::printf("image      %s, %d x %d\ndevice     %s\nedges      %zu",
                  source_.is_own_camera() ? "left pinhole image" : source_.path().c_str(), image.width, image.height,
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
      throw Error(error.exit_code(),
                  (source_.is_own_camera() ? "the left image" : source_.path()) + ": " + error.what());
    }
  }

  /// The left image of a pair as the pinhole camera would have seen it.
  Image left_image() const {
    PairOfSource pair = source_.pair(frame_);
    const auto& table = pair.dataset.rig.left_undistortion;
    return table.empty() ? std::move(pair.pair.left) : undistort(pair.pair.left.view(), table);
  }

  SourceOptions source_;
  int frame_ = 0;
  std::string csv_, draw_;
  bool force_ = false, quiet_ = false;
  MethodOptions method_;
};

}  // namespace

std::unique_ptr<Command> make_edges_command() { return std::make_unique<EdgesCommand>(); }

}  // namespace quadedge::cli
