/// \file command_edges.cpp  quadedge edges: third-order edges of one image.
#include <cstdio>

#include "cli/command.hpp"
#include "cli/method_options.hpp"
#include "cli/output_folder.hpp"
#include "data/atomic_file.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/detect_edges.hpp"
#include "report/drawing.hpp"
#include "report/edges_csv.hpp"
#include "report/statistics.hpp"

namespace quadedge::cli {
namespace {

class EdgesCommand : public Command {
 public:
  std::string name() const override { return "edges"; }
  std::string about() const override { return "detect the third-order edges of one image"; }
  std::string examples() const override {
    return "  quadedge edges image.png --csv edges.csv --draw edges.png\n"
           "  quadedge edges image.png --edges.threshold 4 --csv strong.csv";
  }
  void declare(Options& options) override {
    options.positional("IMAGE", image_, "image file; colour becomes grey");
    options.text("--csv", csv_, "write x,y,direction_rad,strength of every edge", "FILE");
    options.text("--draw", draw_, "write a picture of the edges (PNG)", "FILE");
    options.flag("--force", force_, "replace files that exist");
    options.flag("--quiet", quiet_, "no summary");
    method_.declare(options);
  }
  int run() override {
    const Config config = method_.config();
    check_output_file(csv_, force_);
    check_output_file(draw_, force_);
    const Image image = read_grey_image(image_);
    Device device = method_.open_device();
    const EdgeSet edges = detect_edges(image.view(), device, config);
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
  std::string image_, csv_, draw_;
  bool force_ = false, quiet_ = false;
  MethodOptions method_;
};

}  // namespace

std::unique_ptr<Command> make_edges_command() { return std::make_unique<EdgesCommand>(); }

}  // namespace quadedge::cli
