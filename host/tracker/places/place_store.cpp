/// \file place_store.cpp  VLAD of projected root descriptors; a full store drops the place most like the next one.
#include "places/place_store.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "quadedge/error.hpp"

namespace quadedge::places {
namespace {

constexpr float kWideNorm = 512;  ///< of a wide descriptor

/// Of place_words.bin: floats in the order of the members of PlaceWords, columns one after another, little-endian.
constexpr std::uint8_t kTable[] = {
#include "place_words.inc"
};
static_assert(sizeof kTable == sizeof(float) * (kWideBytes + kWordNumbers * (kWideBytes + kWords)));

}  // namespace

const PlaceWords& place_words() {
  static const PlaceWords words = [] {
    PlaceWords table;
    const std::uint8_t* next = kTable;
    const auto read = [&](auto& matrix) {
      const std::size_t bytes = sizeof(float) * static_cast<std::size_t>(matrix.size());
      std::memcpy(matrix.data(), next, bytes);
      next += bytes;
    };
    read(table.mean);
    read(table.projection);
    read(table.words);
    return table;
  }();
  return words;
}

Eigen::Matrix<float, kWideBytes, Eigen::Dynamic> rooted_descriptors(const frontend::KeptFrameEdges& kept) {
  const std::vector<std::uint8_t> wide = frontend::unpack_wide(kept);
  const Eigen::Map<const Eigen::Matrix<std::uint8_t, kWideBytes, Eigen::Dynamic>> bytes(
      wide.data(), kWideBytes, static_cast<Eigen::Index>(kept.edges.size()));
  return (bytes.cast<float>() / kWideNorm).cwiseSqrt();
}

PlaceSignature place_signature(const frontend::KeptFrameEdges& kept) {
  const PlaceWords& table = place_words();
  const Eigen::Matrix<float, kWordNumbers, Eigen::Dynamic> projected =
      table.projection * (rooted_descriptors(kept).colwise() - table.mean);
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

PlaceStore::Rounded PlaceStore::rounded(const PlaceSignature& signature) {
  Rounded result;
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = static_cast<std::int16_t>(std::lround(32767 * signature[static_cast<Eigen::Index>(i)]));
  return result;
}

void PlaceStore::add(Place place) {
  bytes_ += bytes_of(place);
  rounded_.push_back(rounded(place.signature));
  places_.push_back(std::move(place));
  while (bytes_ > max_bytes_ && places_.size() > 1) {
    auto redundant = places_.begin();
    float highest = -1;
    for (auto next = places_.begin() + 1; next != places_.end(); ++next) {
      const float similarity = (next - 1)->signature.dot(next->signature);
      if (similarity > highest) {
        highest = similarity;
        redundant = next - 1;
      }
    }
    bytes_ -= bytes_of(*redundant);
    rounded_.erase(rounded_.begin() + (redundant - places_.begin()));
    places_.erase(redundant);
  }
}

std::vector<PlaceStore::Similar> PlaceStore::most_similar(const PlaceSignature& signature, int count,
                                                          const std::function<bool(const Place&)>& may_be) const {
  const Rounded wanted = rounded(signature);
  std::vector<std::pair<std::int32_t, std::size_t>> heap(places_.size());  // product, index; of equal ones the latest
  for (std::size_t i = 0; i < heap.size(); ++i) {
    std::int32_t product = 0;  // at most 2^30, since signatures have unit length
    for (std::size_t k = 0; k < wanted.size(); ++k) product += rounded_[i][k] * wanted[k];
    heap[i] = {product, i};
  }
  std::make_heap(heap.begin(), heap.end());
  std::vector<Similar> found;
  while (!heap.empty() && found.size() < static_cast<std::size_t>(count)) {
    const Place& place = places_[heap.front().second];
    if (may_be(place)) found.push_back({&place, place.signature.dot(signature)});
    std::pop_heap(heap.begin(), heap.end());
    heap.pop_back();
  }
  return found;
}

const Place* PlaceStore::find(int node) const {
  const auto place = std::find_if(places_.begin(), places_.end(), [node](const Place& of) { return of.node == node; });
  return place == places_.end() ? nullptr : &*place;
}

void check_map_config(const Config& config) {
  if (config.temporal.global_edges == 0)
    throw UsageError("a map needs the global search: temporal.global_edges above 0");
  if (config.temporal.sift_max > 0)
    throw UsageError("a map keeps no SIFT descriptors: expected temporal.sift_max of 0");
}

std::vector<std::pair<std::string, std::string>> descriptor_settings(const Config& config) {
  constexpr std::array<const char*, 3> kKeys = {"edges.sigma", "edges.direction_at", "patches.offset"};
  std::vector<std::pair<std::string, std::string>> settings;
  for (const Constant& constant : constants())
    if (std::find(kKeys.begin(), kKeys.end(), constant.key()) != kKeys.end())
      settings.emplace_back(constant.key(), constant.text(config));
  return settings;
}

}  // namespace quadedge::places
