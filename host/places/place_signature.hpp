#pragma once
/// \file place_signature.hpp  A rig as one short vector, for finding rigs of the same place (doc/method.md section 10).

#include <Eigen/Core>

#include "common/layouts.hpp"
#include "frontend/kept_frame_edges.hpp"

namespace quadedge::places {

constexpr int kWordNumbers = 16;  ///< numbers of a descriptor after its projection
constexpr int kWords = 16;

/// Unit length; similar places have a large scalar product.
using PlaceSignature = Eigen::Matrix<float, kWords * kWordNumbers, 1>;

/// Table of words and the projection that precedes it. bench/place_words.cpp makes it from rendered scenes.
struct PlaceWords {
  Eigen::Matrix<float, kWideBytes, 1> mean;
  Eigen::Matrix<float, kWordNumbers, kWideBytes> projection;
  Eigen::Matrix<float, kWordNumbers, kWords> words;
};
const PlaceWords& place_words();

/// Wide descriptors of a kept rig as columns: square roots of their values.
Eigen::Matrix<float, kWideBytes, Eigen::Dynamic> rooted_descriptors(const frontend::KeptFrameEdges& rig);

/// Vector of locally aggregated descriptors: for every word the sum of the differences from it of all descriptors
/// nearest to it, each sum of unit length.
PlaceSignature place_signature(const frontend::KeptFrameEdges& rig);

}  // namespace quadedge::places
