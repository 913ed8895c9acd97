/// \file stage_rows.cpp  Quantises results to integer rows, and looks up each within a tolerance.
#include "edges/stage_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "common/printed.hpp"
#include "device/buffer.hpp"
#include "device/context.hpp"
#include "device/images.hpp"
#include "edges/prediction.hpp"
#include "geometry/undistortion.hpp"

namespace quadedge::frontend {
namespace {

using Row = StageRows::Row;

constexpr double kPositions = 100, kDirections = 200, kSimilarities = 500, kGradients = 100;

int units(double value, double per_one) { return static_cast<int>(std::lround(value * per_one)); }
int place(float value) { return units(static_cast<double>(value), kPositions); }

/// Quantises a direction; -pi and pi are equal.
int turned(float direction) {
  const int half_turn = units(kPi, kDirections), value = units(static_cast<double>(direction), kDirections);
  return value <= StageRows::kTolerance - half_turn ? value + 2 * half_turn : value;
}

Row edge_row(const EdgeSet& edges, std::size_t i) {
  return {place(edges.x[i]), place(edges.y[i]), turned(edges.direction[i]),
          units(static_cast<double>(edges.strength[i]), kGradients), 0};
}

/// Converts the data that a tap receives to rows.
class Collector : public Tap {
 public:
  std::vector<Row>& of(const std::string& stage) {
    const auto found =
        std::find_if(stages.begin(), stages.end(), [&](const auto& known) { return known.stage == stage; });
    return (found == stages.end() ? stages.emplace_back(StageRows{stage, {}}) : *found).rows;
  }
  void add_edges(const std::string& stage, const EdgeSet& edges) {
    auto& rows = of(stage);  // also where there are none
    for (std::size_t i = 0; i < edges.size(); ++i) rows.push_back(edge_row(edges, i));
  }
  void add_quads(const std::string& stage, const TemporalMatches& quads, const StereoEdges& base) {
    auto& rows = of(stage);
    for (std::size_t i = 0; i < quads.size(); ++i) {
      const auto before = static_cast<std::size_t>(quads.previous[i]);
      rows.push_back({place(base.left_x[before]), place(base.left_y[before]), place(quads.left_x[i]),
                      place(quads.left_y[i]), units(static_cast<double>(quads.ncc[i]), kSimilarities)});
    }
  }

  void edges(const EdgeSet& left, const EdgeSet& right) override {
    left_ = left;
    right_ = right;
    add_edges("edge_selection", left);
    add_edges("edge_selection", right);
  }
  void stereo_filter(StereoFilter filter, const CandidateLists& lists) override {
    switch (filter) {
      case StereoFilter::orientation:
        add_candidates("stereo_candidates", lists, 0);
        add_candidates("sift", lists, 1);
        break;
      case StereoFilter::sift: add_candidates("patches", lists, kSimilarities); break;
      case StereoFilter::nearly_best_sift: add_candidates("candidate_filters", lists, 0); break;
      case StereoFilter::refinement: add_candidates("stereo_refinement, stereo_clusters", lists, kSimilarities); break;
      case StereoFilter::relaxation: add_candidates("coarse_disparity, stereo_relaxation", lists, 0); break;
      default: break;
    }
  }
  void stereo(const StereoEdges& edges) override { add_stereo("stereo_mutual", edges); }
  void add_stereo(const std::string& stage, const StereoEdges& edges) {
    auto& rows = of(stage);
    for (std::size_t i = 0; i < edges.size(); ++i) {
      rows.push_back({place(edges.left_x[i]), place(edges.left_y[i]), place(edges.right_x[i]), place(edges.right_y[i]),
                      units(static_cast<double>(edges.ncc[i]), kSimilarities)});
    }
  }

  std::vector<StageRows> stages;

 private:
  /// `cue_scale`: units per one of the score that the next filter compares; 0: the score is omitted.
  void add_candidates(const std::string& stage, const CandidateLists& lists, double cue_scale) {
    auto& rows = of(stage);
    for (std::size_t row = 0; row + 1 < lists.first.size(); ++row) {
      for (auto c = static_cast<std::size_t>(lists.first[row]); c < static_cast<std::size_t>(lists.first[row + 1]);
           ++c) {
        const auto target = static_cast<std::size_t>(lists.target[c]);
        const bool refined = !lists.x.empty();
        rows.push_back({place(left_.x[row]), place(left_.y[row]), place(refined ? lists.x[c] : right_.x[target]),
                        place(refined ? lists.y[c] : right_.y[target]),
                        cue_scale > 0 ? units(static_cast<double>(lists.cue[c]), cue_scale) : 0});
      }
    }
  }

  EdgeSet left_, right_;
};

/// A lens that bends straight lines by up to about a pixel.
UndistortionTable mild_distortion(const Image& image) {
  constexpr float kBend = 2e-6F;  // per px^2
  UndistortionTable table{image.width, image.height, {}, {}};
  const float middle_x = static_cast<float>(image.width) / 2, middle_y = static_cast<float>(image.height) / 2;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float dx = static_cast<float>(x) - middle_x, dy = static_cast<float>(y) - middle_y;
      const float scale = 1 + kBend * (dx * dx + dy * dy);
      table.source_x.change().push_back(middle_x + dx * scale);
      table.source_y.change().push_back(middle_y + dy * scale);
    }
  }
  return table;
}

void observe_undistortion(const Image& image, Device& device, const std::map<std::string, std::string>& variants,
                          std::vector<Row>& rows) {
  constexpr int kStep = 53;  // prime, so that every column is used
  const UndistortionTable table = mild_distortion(image);
  Image pinhole(image.width, image.height);
  if (device.is_reference()) {
    pinhole = undistort(image.view(), table);
  } else {
    opencl::Context& context = *device.context();
    stages::Undistortion stage(context, table, image.width, image.height, variants);
    opencl::Buffer<cl_uchar> pixels(context, image.pixel_count());
    stage.run(image.view(), pixels);
    pixels.read(pinhole.pixels.data(), image.pixel_count());
  }
  for (int i = 0; i < image.width * image.height; i += kStep)
    rows.push_back({i % image.width * static_cast<int>(kPositions), i / image.width * static_cast<int>(kPositions),
                    pinhole.view().value(i % image.width, i / image.width), 0, 0});
}

/// The default configuration with every stage enabled.
Config configuration(const SmallSequence& sequence, const std::map<std::string, std::string>& variants) {
  Config config;
  config.stereo.max_disparity = sequence.max_disparity;
  config.stereo.sift_max = 500;
  config.stereo.coarse_ties = 0;
  config.temporal.sift_max = 500;
  config.temporal.coarse_radius = config.temporal.radius;
  config.edges.budget = 200;
  config.variants = variants;
  return config;
}

/// Number of rows of `a` that `b` lacks, and the first of them.
std::size_t missing(const std::vector<Row>& a, const std::vector<Row>& b, const Row*& first) {
  std::size_t count = 0;
  for (const Row& row : a) {
    const auto like_row = [&](const Row& other) {
      return std::equal(row.begin(), row.end(), other.begin(),
                        [](int p, int q) { return std::abs(p - q) <= StageRows::kTolerance; });
    };
    if (std::any_of(b.begin(), b.end(), like_row)) continue;
    if (count++ == 0) first = &row;
  }
  return count;
}

}  // namespace

std::vector<StageRows> observe_stages(const SmallSequence& sequence, Device& device,
                                      const std::map<std::string, std::string>& variants) {
  Collector collector;
  observe_undistortion(sequence.left[0], device, variants, collector.of("undistortion"));
  const StereoFrame first{0, sequence.left[0].view(), sequence.right[0].view()},
      second{50'000'000, sequence.left[1].view(), sequence.right[1].view()};

  const Config config = configuration(sequence, variants);
  Config without_budget = config;
  without_budget.edges.budget = 0;
  const auto all = make_frontend(sequence.rig, device, without_budget);
  all->process(first);
  collector.of("edge_threshold").push_back({units(all->counts().edge_threshold, kGradients), 0, 0, 0, 0});
  collector.add_edges("edge_detection", all->edges(Side::left));

  const auto frontend = make_frontend(sequence.rig, device, config);
  const auto base = frontend->process(first);
  frontend->set_tap(&collector);
  frontend->process(second);
  frontend->set_tap(nullptr);
  const StereoEdges& edges = base->edges;
  collector.add_quads("temporal_match", frontend->match(*base, search_without_motion(edges, config.temporal, false)),
                      edges);
  collector.add_quads("temporal_candidates, temporal_quads",
                      frontend->match(*base, search_without_motion(edges, config.temporal, true)), edges);
  collector.add_quads("wide_description, global_matching",
                      frontend->match_globally(*base, config.temporal.global_edges), edges);
  return std::move(collector.stages);
}

std::vector<StageRows> observe_paper_stages(const SmallSequence& sequence, Device& device, Config config) {
  Collector collector;
  config.stereo.max_disparity = sequence.max_disparity;
  const auto frontend = make_frontend(sequence.rig, device, config);
  const auto base = frontend->process({0, sequence.left[0].view(), sequence.right[0].view()});
  frontend->process({50'000'000, sequence.left[1].view(), sequence.right[1].view()});
  collector.add_edges("grid_edges", frontend->edges(Side::left));
  collector.add_stereo("paper_patches, paper_filters, paper_refinement, paper_clusters", base->edges);
  collector.add_quads("paper_quads", frontend->match(*base, {}), base->edges);
  return std::move(collector.stages);
}

std::string difference(const StageRows& found, const StageRows& expected, double allowed) {
  const Row *first_wrong = nullptr, *first_missing = nullptr;
  const std::size_t wrong = missing(found.rows, expected.rows, first_wrong),
                    lacking = missing(expected.rows, found.rows, first_missing);
  const auto few = [allowed](std::size_t count, std::size_t of) {
    return static_cast<double>(count) <= allowed * static_cast<double>(of);
  };
  if (few(wrong, found.rows.size()) && few(lacking, expected.rows.size())) return {};
  const Row& row = first_missing != nullptr ? *first_missing : *first_wrong;
  return printed(
      "%zu results, the reference has %zu; %zu are wrong and %zu are missing, the first of which "
      "is (%d %d %d %d %d)",
      found.rows.size(), expected.rows.size(), wrong, lacking, row[0], row[1], row[2], row[3], row[4]);
}

}  // namespace quadedge::frontend
