#include "saved_maps.hpp"
#include "scene_corridor.hpp"

using namespace quadedge;

namespace {

struct LocatedWalk {
  int frames = 0, located = 0, followed = 0, wrong = 0;
};

/// Locates every `step`-th frame of a recording from `first` on.
LocatedWalk locate_walk(const SavedMap& map, const SyntheticOptions& options, int step,
                        const std::string& device_name = "0", bool follow = false, int first = 1) {
  const SyntheticSequence sequence(options);
  Device device(device_name, kept_programs());
  Localiser localiser(map, sequence.rig(), device, {}, follow);
  LocatedWalk walk;
  for (int i = first; i < sequence.frames(); i += step) {
    const Localisation found = localiser.locate(sequence.pair(i).view());
    ++walk.frames;
    CHECK(found.stamp_ns == sequence.stamp_ns(i));
    CHECK(found.map_from_left.has_value() == (found.status == LocalisationStatus::located));
    CHECK(found.covariance.has_value() == found.map_from_left.has_value());
    CHECK(found.message.empty() == found.map_from_left.has_value());
    if (!found.map_from_left) continue;
    ++walk.located;
    walk.followed += found.is_followed ? 1 : 0;
    const Eigen::Isometry3d error = sequence.world_from_left(i).inverse() * *found.map_from_left;
    INFO("frame " << i << " against keyframe " << found.key_rig << " off by " << error.translation().norm() << " m");
    const bool is_wrong = error.translation().norm() > 0.05 || Eigen::AngleAxisd(error.linear()).angle() > 1 * kDegree;
    CHECK_FALSE(is_wrong);
    walk.wrong += is_wrong ? 1 : 0;
  }
  return walk;
}

}  // namespace

TEST_CASE("localiser: frames between those of the map are located, on all devices", "[device]") {
  for (const std::string& name : all_devices()) {
    INFO(name);
    const LocatedWalk walk = locate_walk(saved_maps::room_map(), saved_maps::walk("room"), 6, name);
    CHECK(walk.located >= 0.9 * walk.frames);
  }
}

TEST_CASE("localiser: half and double light, and other cameras than the map's", "[device]") {
  const auto located = [](int step, const std::function<void(SyntheticOptions&)>& change) {
    SyntheticOptions other = saved_maps::walk("room");
    change(other);
    const LocatedWalk walk = locate_walk(saved_maps::room_map(), other, step);
    return static_cast<double>(walk.located) / walk.frames;
  };
  for (const double light : {0.5, 2.0}) CHECK(located(12, [&](auto& other) { other.light = light; }) >= 0.9);
  CHECK(located(6, [](auto& other) { other.focal *= 1.15, other.baseline = 0.1; }) >= 0.8);
  CHECK(located(6, [](auto& other) { other.width *= 2, other.height *= 2, other.focal *= 2; }) >= 0.9);
}

TEST_CASE("localiser: a recording is followed, and lost frames are found again", "[device]") {
  const SyntheticSequence sequence(saved_maps::walk("room"));
  Device device("0", kept_programs());
  Localiser localiser(saved_maps::room_map(), sequence.rig(), device, {}, true);
  int followed = 0;
  for (int i = 0; i < 16; ++i) {
    const bool is_black = i == 6;
    StereoPair pair = sequence.pair(i);
    if (is_black) pair.left = pair.right = Image(320, 200);
    const Localisation found = localiser.locate(pair.view());
    INFO(i);
    if (is_black) {
      CHECK(found.status == LocalisationStatus::lost_too_few_edges);
      continue;
    }
    REQUIRE(found.map_from_left);
    CHECK((found.map_from_left->translation() - sequence.world_from_left(i).translation()).norm() < 0.05);
    if (i < 2 || i == 7 || i == 8) CHECK_FALSE(found.is_followed);  // no velocity is known
    followed += found.is_followed ? 1 : 0;
  }
  CHECK(followed >= 9);
}

TEST_CASE("localiser: frames of other scenes are not located", "[device]") {
  for (const char* scene : {"cables", "facade"}) {
    INFO(scene);
    CHECK(locate_walk(saved_maps::room_map(), saved_maps::walk(scene), 6).located == 0);
  }
}

TEST_CASE("localiser: bays of a corridor that the map does not hold are not taken for others with equal doors",
          "[device]") {
  const SavedMap map = saved_maps::map_of(saved_maps::small("corridor", "drive", 49), "0");
  locate_walk(map, saved_maps::small("corridor", "drive", 119), 3, "0", false, 52);
}

TEST_CASE("localiser: the same frames give the same bytes, and others before them hardly matter", "[device]") {
  const SyntheticSequence sequence(saved_maps::walk("room"));
  Device device("0", kept_programs());
  const auto locate = [&](Localiser& localiser, int i) {
    Localisation found = localiser.locate(sequence.pair(i).view());
    REQUIRE(found.map_from_left);
    return found;
  };
  Localiser one(saved_maps::room_map(), sequence.rig(), device), same(saved_maps::room_map(), sequence.rig(), device),
      other(saved_maps::room_map(), sequence.rig(), device);
  const Localisation first = locate(one, 7), second = locate(same, 7);
  CHECK(first.map_from_left->matrix() == second.map_from_left->matrix());
  CHECK(*first.covariance == *second.covariance);
  CHECK(first.inliers == second.inliers);
  // The disparity range follows the images.
  locate(other, 21);
  const Localisation later = locate(other, 7);
  CHECK((later.map_from_left->translation() - first.map_from_left->translation()).norm() < 0.001);
}

TEST_CASE("localiser: exchanged cameras do not fit the calibration", "[device]") {
  const SyntheticSequence sequence(saved_maps::walk("room"));
  Device device("0", kept_programs());
  Localiser localiser(saved_maps::room_map(), sequence.rig(), device);
  const StereoPair pair = sequence.pair(3);
  const Localisation found = localiser.locate({0, pair.right.view(), pair.left.view()});
  CHECK(found.status != LocalisationStatus::located);
}
