/// \file saved_map.cpp  The bytes of a map: little-endian values without gaps, in the order of exchange().
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>

#include "common/printed.hpp"
#include "geometry/calibration.hpp"
#include "geometry/corrected_rig.hpp"
#include "places/place_store.hpp"
#include "quadedge/error.hpp"
#include "quadedge/map.hpp"

namespace quadedge {
namespace {

using places::SavedPlaces;

class Writer {
 public:
  template <class T>
  void value(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    bytes(&value, sizeof value);
  }
  void bytes(const void* values, std::size_t size) { text_.append(static_cast<const char*>(values), size); }
  template <class Values>
  void array(const Values& values, std::size_t) {
    bytes(values.data(), values.size() * sizeof values[0]);
  }
  template <class Values>
  std::size_t count(const Values& values) {
    value(static_cast<std::uint32_t>(values.size()));
    return values.size();
  }
  template <class Values, class Visit>
  void list(const Values& values, const Visit& visit) {
    count(values);
    for (const auto& each : values) visit(each);
  }
  std::string release() { return std::move(text_); }

 private:
  std::string text_;
};

/// The same in reverse. Sizes are checked before memory is allocated.
class Reader {
 public:
  Reader(std::string_view bytes, const std::string& source) : rest_(bytes), source_(source) {}

  template <class T>
  void value(T& value) {
    static_assert(std::is_arithmetic_v<T>);
    bytes(&value, sizeof value);
  }
  void bytes(void* values, std::size_t size) {
    require(size);
    std::memcpy(values, rest_.data(), size);
    rest_.remove_prefix(size);
  }
  template <class Values>
  void array(Values& values, std::size_t count) {
    require(count * sizeof values[0]);
    values.resize(count);
    bytes(values.data(), count * sizeof values[0]);
  }
  template <class Values>
  std::size_t count(const Values&) {
    std::uint32_t count = 0;
    value(count);
    return count;
  }
  template <class Values, class Visit>
  void list(Values& values, const Visit& visit) {
    for (std::size_t left = count(values); left > 0; --left) visit(values.emplace_back());
  }
  std::size_t rest() const { return rest_.size(); }

 private:
  void require(std::size_t bytes) const {
    if (bytes > rest_.size())
      throw DataError(source_ + ": found " + std::to_string(rest_.size()) +
                      " more bytes of the map, expected at least " + std::to_string(bytes));
  }

  std::string_view rest_;
  std::string source_;
};

template <class Archive, class Camera>
void exchange_camera(Archive& archive, Camera& camera) {
  for (auto* value : {&camera.fx, &camera.fy, &camera.cx, &camera.cy}) archive.value(*value);
  for (auto* value : {&camera.width, &camera.height}) archive.value(*value);
}

template <class Archive, class Pose>
void exchange_pose(Archive& archive, Pose& pose) {
  archive.bytes(pose.data(), sizeof(Eigen::Matrix4d));
}

template <class Archive, class Place>
void exchange_place(Archive& archive, Place& place) {
  auto& kept = place.kept;
  archive.value(kept.frame);
  archive.value(kept.edges_spacing);
  archive.bytes(place.signature.data(), sizeof place.signature);
  const std::size_t count = archive.count(kept.edges.left_x);
  for (const auto column : frontend::kStereoColumns) archive.array(kept.edges.*column, count);
  archive.array(kept.edges.ncc, count);
  archive.array(kept.patches, count * frontend::kKeptPatchBytes);
  archive.array(kept.wide, count * frontend::kKeptWideBytes);
}

/// All that a map file holds, to or from an archive.
template <class Archive, class Header, class Places>
void exchange(Archive& archive, Header& map, Places& places) {
  const auto text = [&](auto& value) { archive.array(value, archive.count(value)); };
  archive.list(map.settings, [&](auto& setting) {
    text(setting.first);
    text(setting.second);
  });
  exchange_camera(archive, map.rig.left);
  exchange_camera(archive, map.rig.right);
  exchange_pose(archive, map.rig.right_from_left);
  archive.value(map.rig.max_value);
  archive.value(map.is_undistorted);
  archive.value(map.offset);
  archive.value(map.offset_variance);
  archive.list(map.poses, [&](auto& pose) { exchange_pose(archive, pose); });
  archive.list(places, [&](auto& place) { exchange_place(archive, place); });
}

/// Checks that a map that was read can be used. \throws DataError
class Check {
 public:
  explicit Check(const std::string& source) : source_(source) {}

  void operator()(const SavedPlaces& map, const std::vector<places::Place>& places) const {
    for (const PinholeCamera* camera : {&map.rig.left, &map.rig.right})
      require(camera->width <= kLargestImage && camera->height <= kLargestImage, "an image size",
              std::max(camera->width, camera->height), "at most " + std::to_string(kLargestImage));
    check_rig(map.rig, source_.c_str());
    require(map.rig.max_value >= 1 && map.rig.max_value <= kLargestPixel, "a largest pixel value", map.rig.max_value,
            "1 to " + std::to_string(kLargestPixel));
    require(map.is_undistorted <= 1, "a flag of lens distortion", map.is_undistorted, "0 or 1");
    require(std::abs(map.offset) <= map.rig.left.width, "a disparity offset", map.offset, "at most the image's width");
    require(map.offset_variance == 0 || (map.offset_variance >= kLeastVariance && map.offset_variance <= kMostVariance),
            "a variance", map.offset_variance, "0, or 1e-18 to 1e4 px^2");
    require(map.poses.size() == places.size(), "a number of poses", static_cast<double>(map.poses.size()),
            std::to_string(places.size()) + ", one per keyframe");
    for (const Eigen::Isometry3d& pose : map.poses) check_pose(pose);
    for (const places::Place& place : places) check_place(place, map.rig);
  }

 private:
  static constexpr int kLargestImage = 65536, kLargestPixel = 65535;
  static constexpr double kFarthest = 1e9;                                                     // [m]
  static constexpr double kUnitTolerance = 1e-5, kLeastVariance = 1e-18, kMostVariance = 1e4;  // [px^2]

  void require(bool holds, const std::string& what, double found, const std::string& expected) const {
    if (!holds) throw DataError(source_ + ": found " + what + " of " + printed("%f", found) + ", expected " + expected);
  }
  void check_pose(const Eigen::Isometry3d& pose) const {
    const double deviation = rotation_error(pose.linear());
    require(deviation <= kRotationTolerance && is_affine(pose), "a pose that deviates from a rigid one by", deviation,
            "a rotation and a translation");
    require(pose.translation().norm() <= kFarthest, "a pose at a distance", pose.translation().norm(),
            "a finite number of metres");
  }
  void check_place(const places::Place& place, const StereoRig& rig) const {
    const StereoEdges& edges = place.kept.edges;
    const auto count = edges.left_x.size();
    require(place.kept.frame >= 0, "a frame number", place.kept.frame, "0 or more");
    require(count > 0 && count <= frontend::kKeptEdges, "a number of edges", static_cast<double>(count),
            "1 to " + std::to_string(frontend::kKeptEdges));
    require(place.kept.edges_spacing >= 0 && place.kept.edges_spacing <= rig.left.height, "a spacing of edges",
            place.kept.edges_spacing, "0 to the image's height");
    require(std::abs(place.signature.norm() - 1) < kUnitTolerance, "a signature of length",
            static_cast<double>(place.signature.norm()), "1");
    check_column(edges.left_x, 0, rig.left.width);
    check_column(edges.left_y, 0, rig.left.height);
    check_column(edges.right_x, -kLargestImage, kLargestImage);
    check_column(edges.right_y, -kLargestImage, kLargestImage);
    check_column(edges.left_direction, -kTurn, kTurn);
    check_column(edges.right_direction, -kTurn, kTurn);
    check_column(edges.left_scale_shift, -kLargestImage, kLargestImage);
    check_column(edges.ncc, -1, 2);
  }
  static constexpr double kTurn = 7;  // more than 2 pi
  void check_column(const std::vector<float>& values, double low, double high) const {
    for (const float value : values)
      require(static_cast<double>(value) >= low && static_cast<double>(value) <= high, "an edge with a value", value,
              printed("%f to %f", low, high));
  }

  std::string source_;
};

}  // namespace

SavedMap::SavedMap(SavedPlaces header, std::vector<places::Place> places) {
  RigEstimate learned;
  learned.disparity_offset = header.offset;
  const auto calibration = std::make_shared<StereoRig>(corrected_rig(header.rig, learned));
  for (places::Place& place : places) {
    place.node = static_cast<int>(header.store.size());
    place.kept.own_calibration = calibration;
    header.store.add(std::move(place));
  }
  places_ = std::make_shared<SavedPlaces>(std::move(header));
}

std::size_t SavedMap::key_rigs() const { return places_->store.size(); }
const StereoRig& SavedMap::rig() const { return places_->rig; }
bool SavedMap::is_undistorted() const { return places_->is_undistorted != 0; }

std::string SavedMap::bytes() const {
  Writer writer;
  exchange(writer, *places_, places_->store.places());
  return writer.release();
}

SavedMap SavedMap::from_bytes(std::string_view bytes, const std::string& source) {
  Reader reader(bytes, source);
  SavedPlaces header;
  std::vector<places::Place> places;
  exchange(reader, header, places);
  if (reader.rest() > 0)
    throw DataError(source + ": found " + std::to_string(reader.rest()) + " bytes after the map, expected none");
  Check check(source);
  check(header, places);
  for (places::Place& place : places) {
    place.kept.edges.left_index.resize(place.kept.edges.left_x.size());
    std::iota(place.kept.edges.left_index.begin(), place.kept.edges.left_index.end(), 0);
    place.kept.edges.right_index = place.kept.edges.left_index;
  }
  return {std::move(header), std::move(places)};
}

}  // namespace quadedge
