#pragma once
/// \file place_store.hpp  Kept keyframes: their signatures, those most similar to a given one, and what a map file
/// holds (doc/method.md section 10).

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "common/layouts.hpp"
#include "edges/kept_frame_edges.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge::places {

// A frame as one short vector, for finding frames of the same place (doc/method.md section 10).

constexpr int kWordNumbers = 16;  ///< numbers of a descriptor after its projection
constexpr int kWords = 16;

/// Unit length; similar places have a large scalar product.
using PlaceSignature = Eigen::Matrix<float, kWords * kWordNumbers, 1>;

/// Table of words and the projection that precedes it, of rendered scenes (`place_words` of commit 9dfc0cc).
struct PlaceWords {
  Eigen::Matrix<float, kWideBytes, 1> mean;
  Eigen::Matrix<float, kWordNumbers, kWideBytes> projection;
  Eigen::Matrix<float, kWordNumbers, kWords> words;
};
const PlaceWords& place_words();

/// Wide descriptors of a kept frame as columns: square roots of their values.
Eigen::Matrix<float, kWideBytes, Eigen::Dynamic> rooted_descriptors(const frontend::KeptFrameEdges& kept);

/// Vector of locally aggregated descriptors: for every word the sum of the differences from it of all descriptors
/// nearest to it, each sum of unit length.
PlaceSignature place_signature(const frontend::KeptFrameEdges& kept);

/// A frame is compared with this number of places, the most similar ones; one without a known place with up to
/// kCandidateBatches times as many. If it is found, those of them that see other places are compared as well, in case
/// another matches, too.
constexpr int kCandidates = 5, kCandidateBatches = 4;

/// A kept frame.
struct Place {
  frontend::KeptFrameEdges kept;
  PlaceSignature signature;
  int node = 0;  ///< of the pose graph
};

/// Keeps places within a bound of memory: beyond it, the place that is most similar to the one after it leaves.
class PlaceStore {
 public:
  /// \param max_bytes at least room for one place remains
  explicit PlaceStore(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  void add(Place place);
  /// A place and the scalar product of its signature with the given one.
  struct Similar {
    const Place* place;
    float similarity;
  };
  /// The `count` most similar places that `may_be` accepts, best first; valid until the next add().
  std::vector<Similar> most_similar(const PlaceSignature& signature, int count,
                                    const std::function<bool(const Place&)>& may_be) const;

  /// The place of a node; null if it has left or was never kept.
  const Place* find(int node) const;
  std::size_t size() const { return places_.size(); }
  std::size_t bytes() const { return bytes_; }
  const std::vector<Place>& places() const { return places_; }

 private:
  /// A signature in whole numbers. In an array of their own, those of 100,000 places are compared in a few
  /// milliseconds.
  using Rounded = std::array<std::int16_t, kWords * kWordNumbers>;
  static Rounded rounded(const PlaceSignature& signature);
  static std::size_t bytes_of(const Place& place) { return sizeof(Place) + sizeof(Rounded) + place.kept.bytes(); }

  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::vector<Place> places_;     ///< oldest first
  std::vector<Rounded> rounded_;  ///< their signatures
};

// What a map file holds (doc/method.md section 10).

struct SavedPlaces {
  StereoRig rig;  ///< without undistortion tables and masks
  /// 1 if the recorded images had lens distortion, so that `rig` does not describe them.
  std::uint8_t is_undistorted = 0;
  /// Disparity offset that the odometry has learned [px], and its variance [px^2].
  double offset = 0, offset_variance = 0;
  std::vector<std::pair<std::string, std::string>> settings;  ///< descriptor_settings() of the recording
  PlaceStore store{std::numeric_limits<std::size_t>::max()};  ///< Place::node is an index of `poses`
  std::vector<Eigen::Isometry3d> poses;                       ///< map_from_left of every place [m]
};

/// \throws UsageError if `temporal.global_edges` is 0 or a filter in time uses SIFT: kept frames have no images.
void check_map_config(const Config& config);

/// Keys and values of the constants that edges, patches and descriptors depend on, which have to be equal for all
/// frames of a map and the frames located in it.
std::vector<std::pair<std::string, std::string>> descriptor_settings(const Config& config);

}  // namespace quadedge::places
