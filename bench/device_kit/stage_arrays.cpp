#include "device_kit/stage_arrays.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "frontend/frontend.hpp"
#include "frontend/prediction.hpp"
#include "opencl/buffer.hpp"
#include "stages/undistortion.hpp"

namespace device_kit {
namespace {

using namespace quadedge;

template <class T>
constexpr char type_letter() {
  if constexpr (std::is_same_v<T, float>) return 'f';
  if constexpr (std::is_same_v<T, double>) return 'd';
  return sizeof(T) == 1 ? 'b' : 'i';
}

std::size_t value_size(char type) { return type == 'd' ? 8 : type == 'b' ? 1 : 4; }

class Arrays {
 public:
  template <class T>
  void add(const std::string& stage, const std::string& values, const std::vector<T>& data) {
    arrays.push_back({stage, values, type_letter<T>(),
                      std::string(reinterpret_cast<const char*>(data.data()), data.size() * sizeof(T))});
  }
  void add(const std::string& stage, const std::string& image, const EdgeSet& edges) {
    add(stage, image + " x [px]", edges.x);
    add(stage, image + " y [px]", edges.y);
    add(stage, image + " direction [rad]", edges.direction);
    add(stage, image + " strength", edges.strength);
  }
  void add(const std::string& stage, const TemporalMatches& quads) {
    add(stage, "previous edge", quads.previous);
    add(stage, "current edge", quads.current);
    add(stage, "NCC", quads.ncc);
  }
  std::vector<StageArray> arrays;
};

/// Stores the output of the stereo stages, or with `only_sift` only the SIFT distances.
class StereoTap : public Tap {
 public:
  StereoTap(Arrays& arrays, bool only_sift) : arrays_(arrays), only_sift_(only_sift) {}

  void edges(const EdgeSet& left, const EdgeSet& right) override {
    if (only_sift_) return;
    arrays_.add("edge_selection", "left", left);
    arrays_.add("edge_selection", "right", right);
  }
  void stereo_filter(StereoFilter filter, const CandidateLists& lists) override {
    if (only_sift_) {
      if (filter == StereoFilter::orientation) arrays_.add("sift", "distance", lists.cue);
      return;
    }
    switch (filter) {
      case StereoFilter::orientation:
        arrays_.add("stereo_candidates", "first", lists.first);
        arrays_.add("stereo_candidates", "right edge", lists.target);
        break;
      case StereoFilter::sift: arrays_.add("patches", "NCC", lists.cue); break;
      case StereoFilter::nearly_best_sift: arrays_.add("candidate_filters", "right edge", lists.target); break;
      case StereoFilter::refinement:
        arrays_.add("stereo_refinement, stereo_clusters", "right x [px]", lists.x);
        arrays_.add("stereo_refinement, stereo_clusters", "right y [px]", lists.y);
        arrays_.add("stereo_refinement, stereo_clusters", "NCC", lists.cue);
        break;
      case StereoFilter::relaxation: arrays_.add("stereo_relaxation", "right x [px]", lists.x); break;
      default: break;
    }
  }

 private:
  Arrays& arrays_;
  bool only_sift_;
};

void add_undistorted(const Sequence& sequence, Device& device, const Config& config, Arrays& arrays) {
  const StereoRig& rig = sequence.rig;
  if (rig.left_undistortion.empty()) return;
  opencl::Context& context = *device.context();
  stages::Undistortion stage(context, rig.left_undistortion, rig.left.width, rig.left.height, config.variants);
  const std::size_t count = static_cast<std::size_t>(rig.left.width) * static_cast<std::size_t>(rig.left.height);
  opencl::Buffer<cl_uchar> pixels(context, count);
  stage.run(sequence.frames.at(0).left.view(), pixels);
  arrays.add("undistortion", "grey levels", pixels.read(count));
}

void add_detection(const Sequence& sequence, Device& device, Config config, Arrays& arrays) {
  config.edges.budget = 0;
  const auto frontend = frontend::make_frontend(sequence.rig, device, config);
  frontend->process(sequence.frames.at(0).view());
  arrays.add("edge_threshold", "grey levels per px", std::vector<double>{frontend->counts().edge_threshold});
  arrays.add("edge_detection", "left", frontend->edges(Side::left));
}

void add_pair(const Sequence& sequence, Device& device, const Config& config, Arrays& arrays) {
  const auto frontend = frontend::make_frontend(sequence.rig, device, config);
  const auto base = frontend->process(sequence.frames.at(0).view());
  StereoTap tap(arrays, false);
  frontend->set_tap(&tap);
  const auto now = frontend->process(sequence.frames.at(1).view());
  frontend->set_tap(nullptr);
  const StereoEdges& edges = now->edges;
  arrays.add("stereo_mutual", "left edge", edges.left_index);
  arrays.add("stereo_mutual", "right x [px]", edges.right_x);
  arrays.add("stereo_mutual", "right y [px]", edges.right_y);
  arrays.add("stereo_mutual", "right direction [rad]", edges.right_direction);
  arrays.add("stereo_mutual", "NCC", edges.ncc);
  const auto search = [&](bool coarse) {
    return frontend::search_without_motion(base->edges, config.temporal, coarse);
  };
  arrays.add("point_index, temporal_match", frontend->match(*base, search(false)));
  arrays.add("temporal_match, coarse", frontend->match(*base, search(true)));
  arrays.add("wide_description, wide_matching", frontend->match_globally(*base));
}

/// The stages that run with SIFT alone.
void add_sift(const Sequence& sequence, Device& device, Config config, Arrays& arrays) {
  constexpr double kPaperSiftMax = 500;
  config.stereo.sift_max = config.temporal.coarse_sift_max = kPaperSiftMax;
  const auto frontend = frontend::make_frontend(sequence.rig, device, config);
  const auto base = frontend->process(sequence.frames.at(0).view());
  StereoTap tap(arrays, true);
  frontend->set_tap(&tap);
  frontend->process(sequence.frames.at(1).view());
  frontend->set_tap(nullptr);
  arrays.add("temporal_candidates, temporal_quads",
             frontend->match(*base, frontend::search_without_motion(base->edges, config.temporal, true)));
}

}  // namespace

std::size_t StageArray::size() const { return bytes.size() / value_size(type); }

double StageArray::at(std::size_t i) const {
  const char* place = bytes.data() + i * value_size(type);
  const auto as = [&](auto value) {
    std::memcpy(&value, place, sizeof value);
    return static_cast<double>(value);
  };
  switch (type) {
    case 'f': return as(0.0F);
    case 'd': return as(0.0);
    case 'i': return as(std::int32_t{});
    default: return as(std::uint8_t{});
  }
}

std::vector<StageArray> observe_arrays(const Sequence& sequence, Device& device, const Config& config) {
  Arrays arrays;
  add_undistorted(sequence, device, config, arrays);
  add_detection(sequence, device, config, arrays);
  add_pair(sequence, device, config, arrays);
  add_sift(sequence, device, config, arrays);
  return std::move(arrays.arrays);
}

std::vector<StageArray> pose_arrays(const std::vector<FrameResult>& results) {
  Arrays arrays;
  for (const auto& result : results) {
    std::vector<double> pose;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) pose.push_back(result.pose_or_prediction().matrix()(row, column));
    arrays.add("poses", std::string(to_string(result.status)), pose);
  }
  return std::move(arrays.arrays);
}

ArrayDifference difference(const StageArray& found, const StageArray& expected) {
  ArrayDifference result;
  result.values = expected.size();
  result.found = found.size();
  if (found.type != expected.type) throw std::runtime_error(expected.stage + ": stored with another type");
  for (std::size_t i = 0; i < std::min(result.values, result.found); ++i) {
    const std::size_t size = value_size(found.type);
    if (std::memcmp(found.bytes.data() + i * size, expected.bytes.data() + i * size, size) == 0) continue;
    ++result.differing;
    const double apart = std::abs(found.at(i) - expected.at(i));
    result.largest = std::max(result.largest, std::isnan(apart) ? std::numeric_limits<double>::infinity() : apart);
  }
  if (result.values != result.found) result.largest = std::numeric_limits<double>::infinity();
  return result;
}

void write_arrays(const std::string& file, const std::vector<StageArray>& arrays) {
  std::ofstream stream(file, std::ios::binary);
  for (const auto& array : arrays)
    stream << array.stage << '\t' << array.values << '\t' << array.type << '\t' << array.bytes.size() << '\n'
           << array.bytes;
  if (!stream.flush()) throw std::runtime_error(file + ": cannot be written");
}

std::vector<StageArray> read_arrays(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error(file + ": cannot be opened");
  std::vector<StageArray> arrays;
  for (std::string stage; std::getline(stream, stage, '\t');) {
    StageArray& array = arrays.emplace_back();
    array.stage = stage;
    std::size_t size = 0;
    std::getline(stream, array.values, '\t');
    stream >> array.type >> size;
    stream.get();
    if (stream) array.bytes.resize(size);
    stream.read(array.bytes.data(), static_cast<std::streamsize>(array.bytes.size()));
    if (!stream) throw std::runtime_error(file + ": ends early");
  }
  return arrays;
}

}  // namespace device_kit
