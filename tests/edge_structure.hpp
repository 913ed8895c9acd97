#pragma once
/// \file edge_structure.hpp  Properties of every set of edges that the reference detects, shared by tests.

#include "common/filter_limits.hpp"
#include "reference/edge_detection.hpp"
#include "testing.hpp"

/// The threshold of tests without a threshold stage: the fixed one, or the one for images of normal contrast.
inline double threshold_of(const quadedge::EdgesConfig& config) {
  return config.threshold > 0 ? config.threshold : quadedge::kThresholdMax;
}

inline quadedge::reference::ReferenceEdges detect_edges(const quadedge::ImageView& image,
                                                        const quadedge::EdgesConfig& config) {
  return quadedge::reference::detect_edges(image, config, threshold_of(config));
}

inline void check_structure(const quadedge::reference::ReferenceEdges& edges, int width, int height,
                            const quadedge::EdgesConfig& config) {
  REQUIRE(edges.row_first.size() == static_cast<std::size_t>(height + 1));
  CHECK(edges.row_first.front() == 0);
  CHECK(edges.row_first.back() == static_cast<int>(edges.size()));
  for (int row = 0; row < height; ++row) {
    const auto r = static_cast<std::size_t>(row);
    REQUIRE(edges.row_first[r] <= edges.row_first[r + 1]);
    for (auto i = static_cast<std::size_t>(edges.row_first[r]); i < static_cast<std::size_t>(edges.row_first[r + 1]);
         ++i) {
      REQUIRE(edges.row[i] == row);
      if (i > static_cast<std::size_t>(edges.row_first[r])) REQUIRE(edges.column[i - 1] < edges.column[i]);
      REQUIRE(std::abs(edges.y[i] - row) < quadedge::kEdgeRowReach);
      REQUIRE(std::abs(edges.x[i] - edges.column[i]) < quadedge::kEdgeRowReach);
    }
  }
  for (std::size_t i = 0; i < edges.size(); ++i) {
    REQUIRE(edges.strength[i] > threshold_of(config));
    REQUIRE((edges.direction[i] > -quadedge::kPi && edges.direction[i] <= quadedge::kPi));
    REQUIRE((edges.x[i] > config.margin && edges.x[i] < width - 1 - config.margin));
    REQUIRE((edges.y[i] > config.margin && edges.y[i] < height - 1 - config.margin));
  }
}
