#include "places/place_signature.hpp"

#include <array>

namespace quadedge::places {
namespace {

constexpr float kWideNorm = 512;  ///< of a wide descriptor

constexpr std::array<float, kWideBytes + kWordNumbers*(kWideBytes + kWords)> kTable = {
#include "places/place_words.inc"
};

}  // namespace

const PlaceWords& place_words() {
  static const PlaceWords words = [] {
    PlaceWords table;
    const float* next = kTable.data();
    const auto take = [&](auto& matrix) {
      matrix = Eigen::Map<const std::decay_t<decltype(matrix)>>(next);
      next += matrix.size();
    };
    take(table.mean);
    take(table.projection);
    take(table.words);
    return table;
  }();
  return words;
}

Eigen::Matrix<float, kWideBytes, Eigen::Dynamic> rooted_descriptors(const frontend::KeptFrameEdges& rig) {
  const std::vector<std::uint8_t> wide = frontend::unpack_wide(rig);
  const Eigen::Map<const Eigen::Matrix<std::uint8_t, kWideBytes, Eigen::Dynamic>> bytes(
      wide.data(), kWideBytes, static_cast<Eigen::Index>(rig.edges.size()));
  return (bytes.cast<float>() / kWideNorm).cwiseSqrt();
}

PlaceSignature place_signature(const frontend::KeptFrameEdges& rig) {
  const PlaceWords& table = place_words();
  const Eigen::Matrix<float, kWordNumbers, Eigen::Dynamic> projected =
      table.projection * (rooted_descriptors(rig).colwise() - table.mean);
  const Eigen::Matrix<float, kWords, 1> half_squares = 0.5F * table.words.colwise().squaredNorm().transpose();
  PlaceSignature signature = PlaceSignature::Zero();
  for (Eigen::Index i = 0; i < projected.cols(); ++i) {
    Eigen::Index word = 0;
    (table.words.transpose() * projected.col(i) - half_squares).maxCoeff(&word);
    signature.segment<kWordNumbers>(word * kWordNumbers) += projected.col(i) - table.words.col(word);
  }
  for (int word = 0; word < kWords; ++word) signature.segment<kWordNumbers>(word * kWordNumbers).stableNormalize();
  signature.stableNormalize();
  return signature;
}

}  // namespace quadedge::places
