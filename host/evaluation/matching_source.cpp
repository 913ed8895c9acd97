#include "evaluation/matching_source.hpp"

#include <filesystem>
#include <limits>

#include "data/find_sequences.hpp"
#include "data/float_map.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"

namespace quadedge::evaluation {
namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t kMaskOccluded = 128,
                       kMaskUnknown = 0;  // in mask0nocc.png, whose third value, 255, means visible in both views

/// File names of the right view's disparities and of the mask that belong to those of a left view, in the published
/// layouts.
struct Companions {
  const char *left, *right, *mask;
};
constexpr Companions kCompanions[] = {{"disp0GT.pfm", "disp1GT.pfm", "mask0nocc.png"},
                                      {"disp0.pfm", "disp1.pfm", "mask0nocc.png"},
                                      {"disp1.png", "disp5.png", ""},
                                      {"disp2.png", "disp6.png", ""}};

void check_size(const SurfaceMap& map, const PinholeCamera& camera, const std::string& file) {
  if (map.width == camera.width && map.height == camera.height) return;
  data::fail(file, std::to_string(map.width) + " x " + std::to_string(map.height) + " values",
             std::to_string(camera.width) + " x " + std::to_string(camera.height) + " as in the image");
}

SurfaceMap read_disparity(const std::string& file, double scale, const PinholeCamera& camera) {
  SurfaceMap map = fs::path(file).extension() == ".pfm" ? surface_from_disparity(data::read_float_map(file), scale)
                                                        : surface_from_grey(read_grey_image(file), scale);
  check_size(map, camera, file);
  return map;
}

/// depth/NAME.pfm for rgb/NAME.png, depth2/NAME.pfm for rgb2/NAME.png.
std::string depth_file(const std::string& image) {
  const fs::path path(image), folder = path.parent_path();
  const std::string name = folder.filename().string();
  if (name.rfind("rgb", 0) != 0) return {};
  return (folder.parent_path() / ("depth" + name.substr(3)) / path.stem()).string() + ".pfm";
}

/// \param file disparities of the left view
FrameTruth read_pair_truth(const Dataset& dataset, const std::string& file) {
  FrameTruth truth;
  const fs::path left(file);
  truth.left = read_disparity(file, dataset.disparity_truth_scale, dataset.rig.left);
  for (const auto& names : kCompanions) {
    if (left.filename() != names.left) continue;
    const fs::path right = left.parent_path() / names.right, mask = left.parent_path() / names.mask;
    if (fs::exists(right)) {
      truth.right = read_disparity(right.string(), dataset.disparity_truth_scale, dataset.rig.right);
      truth.right_is_measured = true;
    }
    if (*names.mask != '\0' && fs::exists(mask)) {
      const Image image = to_8_bits(read_grey_image(mask.string()).view());
      check_size({image.width, image.height, {}}, dataset.rig.left, mask.string());
      for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        truth.occluded.push_back(image.pixels[i] == kMaskOccluded ? 1 : 0);
        if (image.pixels[i] == kMaskUnknown) truth.left.nearness[i] = std::numeric_limits<float>::quiet_NaN();
      }
    }
  }
  if (!truth.right_is_measured) truth.right = right_from_left(truth.left, dataset.rig.right.width);
  return truth;
}

class RecordedSource : public MatchingSource {
 public:
  explicit RecordedSource(const Dataset& dataset) : dataset_(dataset) {}
  std::string name() const override { return dataset_.name; }
  const StereoRig& rig() const override { return dataset_.rig; }
  int frames() const override { return static_cast<int>(dataset_.frames.size()); }
  TrueFrame load(int number) const override {
    const FrameFiles& files = dataset_.frames[static_cast<std::size_t>(number)];
    TrueFrame frame;
    frame.frame = {number, files.stamp_ns, read_grey_image(files.left), read_grey_image(files.right)};
    const double scale = dataset_.rig.left.fx * dataset_.rig.baseline();
    if (!dataset_.disparity_truth.empty()) {
      const fs::path pair = fs::path(files.left).parent_path(), of_first(dataset_.disparity_truth);
      const bool is_sequence = frames() > 1;  // a file of the same name beside every left image
      frame.truth = read_pair_truth(dataset_, is_sequence ? (pair / of_first.filename()).string() : of_first.string());
      if (is_sequence && dataset_.rig.left.cx == dataset_.rig.right.cx) frame.truth.depth_scale = scale;
    } else {
      frame.truth.depth_scale = scale;
      frame.truth.right_is_measured = true;
      frame.truth.left = surface_from_depth(data::read_float_map(depth_file(files.left)), scale);
      frame.truth.right = surface_from_depth(data::read_float_map(depth_file(files.right)), scale);
      check_size(frame.truth.left, dataset_.rig.left, depth_file(files.left));
      check_size(frame.truth.right, dataset_.rig.right, depth_file(files.right));
    }
    for (const auto& pose : dataset_.truth) {
      if (pose.stamp_ns == files.stamp_ns) frame.truth.world_from_left = pose.world_from_left;
    }
    return frame;
  }

 private:
  Dataset dataset_;
};

class RenderedSource : public MatchingSource {
 public:
  explicit RenderedSource(const SyntheticOptions& options) : sequence_(options) {}
  std::string name() const override { return sequence_.name(); }
  const StereoRig& rig() const override { return sequence_.rig(); }
  int frames() const override { return sequence_.frames(); }
  TrueFrame load(int number) const override {
    RenderedView left = sequence_.render(number, Side::left), right = sequence_.render(number, Side::right);
    TrueFrame frame;
    frame.truth.depth_scale = rig().left.fx * rig().baseline();
    frame.truth.right_is_measured = true;
    const auto map = [&](RenderedView& view) {
      return surface_from_depth({view.image.width, view.image.height, std::move(view.depth)}, frame.truth.depth_scale);
    };
    frame.truth.left = map(left);
    frame.truth.right = map(right);
    frame.truth.world_from_left = sequence_.world_from_left(number);
    frame.frame = {number, sequence_.stamp_ns(number), std::move(left.image), std::move(right.image)};
    return frame;
  }

 private:
  SyntheticSequence sequence_;
};

}  // namespace

bool has_matching_truth(const Dataset& dataset) {
  if (!dataset.disparity_truth.empty()) return true;
  if (dataset.frames.empty()) return false;
  const std::string left = depth_file(dataset.frames[0].left), right = depth_file(dataset.frames[0].right);
  return !left.empty() && fs::exists(left) && fs::exists(right);
}

std::unique_ptr<MatchingSource> make_recorded_source(const Dataset& dataset) {
  if (!has_matching_truth(dataset)) {
    data::fail(dataset.path, "no ground truth of edges",
               "disparities (pairs), or depths and poses as written by `quadedge synth`");
  }
  if (!dataset.rig.left_undistortion.empty() || !dataset.rig.right_undistortion.empty()) {
    data::fail(dataset.path, "distorted images", "pinhole images, to which the ground truth refers");
  }
  return std::make_unique<RecordedSource>(dataset);
}

std::unique_ptr<MatchingSource> make_rendered_source(const SyntheticOptions& options) {
  return std::make_unique<RenderedSource>(options);
}

std::vector<Dataset> find_true_datasets(const std::string& path, std::vector<std::string>& skipped) {
  std::vector<Dataset> found;
  try {
    found.push_back(open_dataset(path));
    return found;
  } catch (const DataError&) {
    if (!fs::is_directory(path)) throw;
    std::vector<std::string> damaged;
    for (const auto& recording : data::find_recordings(path, true)) {
      try {
        Dataset dataset = open_dataset(recording.path);
        if (has_matching_truth(dataset))
          found.push_back(std::move(dataset));
        else
          skipped.push_back(recording.path + ": no ground truth for edges");
      } catch (const DataError& problem) {
        damaged.emplace_back(problem.what());
      }
    }
    if (found.empty() && skipped.empty()) throw;
    skipped.insert(skipped.end(), damaged.begin(), damaged.end());
  }
  if (found.empty())
    data::fail(path, std::to_string(skipped.size()) + " datasets, none with ground truth", "disparities or depth");
  return found;
}

}  // namespace quadedge::evaluation
