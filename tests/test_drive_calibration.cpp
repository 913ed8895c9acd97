/// \file test_drive_calibration.cpp  A rig learned from a drive: from made-up points with every lens model, from
/// rendered frames, and by the commands.

#include "calibration/pair_adjustment.hpp"
#include "calibration/pair_collection.hpp"
#include "calibration/unseen_views.hpp"
#include "dataset_files.hpp"
#include "geometry/calibration.hpp"
#include "geometry/lens_mapping.hpp"
#include "matching.hpp"
#include "output/calibration_report.hpp"
#include "program.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;

namespace {

StereoCalibration made_up_rig(LensModel model, const std::vector<double>& parameters, double focal = 450) {
  StereoCalibration rig;
  rig.left.model = rig.right.model = model;
  rig.left.camera = rig.right.camera = {focal, focal, 320, 200, 640, 400};
  rig.left.parameters = rig.right.parameters = parameters;
  rig.right_from_left.linear() = rotation_by({0.002, -0.01, 0.004});
  rig.right_from_left.translation() = Eigen::Vector3d(-0.2, 0.002, 0.001);
  return rig;
}

/// Pairs of frames of a camera that drives and turns past points at 1 to 40 m, seen with a little noise.
std::vector<rig::FramePair> made_up_pairs(const StereoCalibration& rig, int count, double noise) {
  matching::Random random(7);
  const LensMapping lenses[] = {LensMapping(rig.left), LensMapping(rig.right)};
  std::vector<rig::FramePair> pairs;
  for (int p = 0; p < count; ++p) {
    rig::FramePair pair{p, p + 1, Eigen::Isometry3d::Identity(), {}};
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.linear() = rotation_by({random(-0.02, 0.02), random(-0.06, 0.06), random(-0.02, 0.02)});
    motion.translation() = Eigen::Vector3d(random(-0.1, 0.1), random(-0.05, 0.05), random(-0.5, -0.3));
    pair.second_from_first.translation() = motion.translation();  // as far as known
    while (pair.points.size() < 120) {
      const auto ray = lenses[0].ray({random(5, 635), random(5, 395)});
      if (!ray || !(ray->z() > 0.05)) continue;
      const Eigen::Vector3d first = *ray / random(0.025, 1), second = motion * first;
      const Eigen::Vector3d places[] = {first, rig.right_from_left * first, second, rig.right_from_left * second};
      rig::SeenPoint point;
      for (std::size_t view = 0; view < rig::kViews; ++view) {
        const auto seen = lenses[view % 2].project(places[view]);
        point.is_seen[view] = seen && seen->minCoeff() > 0 && seen->x() < 639 && seen->y() < 399;
        point.at[view] =
            seen.value_or(Eigen::Vector2d::Zero()) + Eigen::Vector2d(random(-noise, noise), random(-noise, noise));
      }
      if (point.is_seen[0] && point.is_seen[1] && point.is_seen[2]) pair.points.push_back(point);
    }
    pairs.push_back(pair);
  }
  return pairs;
}

std::vector<const rig::FramePair*> pointers_to(const std::vector<rig::FramePair>& pairs) {
  std::vector<const rig::FramePair*> all;
  for (const auto& pair : pairs) all.push_back(&pair);
  return all;
}

/// The largest displacement() over the middle of both images.
double largest_displacement(const StereoCalibration& one, const StereoCalibration& other) {
  double largest = 0;
  for (const Side side : kSides)
    for (int y = 50; y <= 350; y += 50)
      for (int x = 50; x <= 590; x += 60)
        largest = std::max(largest, displacement(one, other, side, Eigen::Vector2d(x, y)).norm());
  return largest;
}

SyntheticOptions small_room(int frames) { return rendering(400, 208, 230, frames, 2); }

/// The room from every fifth place of the path, small.
const std::vector<StereoPair>& room_frames() {
  static const std::vector<StereoPair> frames = [] {
    const SyntheticSequence sequence(small_room(64));
    std::vector<StereoPair> rendered;
    for (int i = 0; i < sequence.frames(); i += 5) rendered.push_back(sequence.pair(i));
    return rendered;
  }();
  return frames;
}

StereoCalibration room_calibration() { return SyntheticSequence(small_room(1)).calibration(); }

DriveCalibration learned_in_room(const StereoCalibration& given) {
  DriveCalibrator calibrator(given, make_rig(given));
  for (const StereoPair& pair : room_frames()) calibrator.see(pair.view());
  return calibrator.finish();
}

}  // namespace

TEST_CASE("drive calibration: every lens model learns what is wrong with it", "[rig]") {
  const auto [model, sound, change] = GENERATE(table<LensModel, std::vector<double>, std::vector<double>>({
      {LensModel::radial_tangential, {}, {0.02, 0, 0, 0, 0}},
      {LensModel::radial_tangential, {-0.28, 0.07, 0.0002, 0.0001}, {0.01, 0, 0.0003, 0, 0}},
      {LensModel::radial_tangential, {0.5, 0.1, 0, 0, 0.01, 0.8, 0.2, 0.01}, {0.01, 0, 0, 0, 0, 0, 0, 0}},
      {LensModel::equidistant, {-0.01, 0.02, -0.01, 0.003}, {0.01, 0, 0, 0}},
      {LensModel::field_of_view, {0.9}, {0.01}},
      {LensModel::double_sphere, {-0.2, 0.55}, {0, 0.01}},
      {LensModel::extended_unified, {0.6, 1.1}, {0.01, 0}},
      {LensModel::omnidirectional, {0.8, -0.1, 0.02, 0, 0}, {0, 0.05, 0, 0, 0}},
      {LensModel::omnidirectional, {0.8}, {0, 0.05, 0, 0, 0}},
  }));
  INFO(to_string(model) << " with " << sound.size() << " parameters");
  const StereoCalibration truth = made_up_rig(model, sound);
  StereoCalibration given = truth;
  given.right.parameters = change;
  for (std::size_t k = 0; k < sound.size(); ++k) given.right.parameters[k] += sound[k];
  given.right_from_left.linear() = rotation_by({0.001, 0.002, -0.0005}) * truth.right_from_left.linear();
  const auto pairs = made_up_pairs(truth, 16, 0.05);
  const rig::RigUnknowns unknowns(given);
  rig::PairAdjustment adjustment(unknowns, pointers_to(pairs));
  const Eigen::VectorXd values = adjustment.learn();
  const double before = largest_displacement(truth, given), after = largest_displacement(truth, unknowns.at(values));
  CHECK(before > 0.8);
  CHECK(after < 0.25 * before);
  CHECK(values.dot(adjustment.information() * values) > 15);
  // What is right already stays.
  const rig::RigUnknowns right(truth);
  rig::PairAdjustment nothing(right, pointers_to(pairs));
  const Eigen::VectorXd none = nothing.learn();
  CHECK(none.dot(nothing.information() * none) < 1);
}

TEST_CASE("drive calibration: points of the whole left image, where the lens shows no near point, too", "[rig]") {
  StereoCalibration given = room_calibration();
  for (Lens* lens : {&given.left, &given.right}) lens->parameters = {-0.015, 0, 0, 0};
  constexpr double kDisparity = 1200;
  const auto ray = LensMapping(given.left).ray({60, 104});
  REQUIRE(ray);
  REQUIRE_FALSE(LensMapping(given.right).project(*ray - Eigen::Vector3d(1024 / given.left.camera.fx, 0, 0)));
  const rig::RigUnknowns unknowns(given);
  rig::PairCollector collector(unknowns, kDisparity, {});
  int points = 0, at_left = 0;
  for (std::size_t i = 0; i < room_frames().size(); ++i) {
    const auto pair = collector.see(room_frames()[i].view(), static_cast<int>(i));
    if (!pair) continue;
    points += static_cast<int>(pair->points.size());
    for (const rig::SeenPoint& point : pair->points)
      at_left += point.at[rig::kLeftFirst].x() < given.left.camera.width / 3.0 ? 1 : 0;
  }
  REQUIRE(points > 200);
  CHECK(at_left > points / 5);
}

TEST_CASE("drive calibration: wrong rigs of the rendered room are mended, a sound one stays", "[rig]") {
  const StereoCalibration truth = room_calibration();
  const DriveCalibration sound = learned_in_room(truth);
  CHECK(sound.verdict == CalibrationVerdict::as_good);
  CHECK(sound.contradiction < 1);
  CHECK(sound.calibration.right_from_left.matrix() == truth.right_from_left.matrix());
  CHECK(sound.calibration.left.parameters == truth.left.parameters);
  CHECK_THAT(sound.text(), Contains("as good as given"));
  // Depths are f b / d in a rig without rotation.
  const std::string first_sentence = sound.text().substr(0, sound.text().find(". "));
  CHECK_THAT(first_sentence, Contains("not observed: focal length, both (10 % would change depths of 10 m by 10 %)"));
  const std::string table = report::calibration_table(sound);
  REQUIRE(sound.numbers[0].is_open());
  CHECK_THAT(table.substr(0, table.find("focal length, right")), Contains("not observed"));

  StereoCalibration wrong = truth;
  wrong.right_from_left.linear() = rotation_by(Eigen::Vector3d(0.1, 0.2, 0.05) * kDegree);
  wrong.right.camera.cy += 0.5;
  wrong.right.parameters = {0.01, 0, 0, 0};
  const DriveCalibration mended = learned_in_room(wrong);
  CHECK(mended.verdict == CalibrationVerdict::better);
  CHECK(mended.unseen_learned[0] < 0.7 * mended.unseen_given[0]);
  CHECK(mended.unseen_learned[1] < 0.7 * mended.unseen_given[1]);
  CHECK(rounded_rotation(mended.calibration.right_from_left).cwiseAbs().maxCoeff() < 0.06 * kDegree + 0.5 / 230);
  REQUIRE(mended.change.depths.size() == 5);
  CHECK(mended.change.depths[4].error > 0.1);  // 0.2 degrees of yaw are 0.8 px: half the disparity at 50 m and more
  CHECK_THAT(mended.text(), Contains("the calibration is off"));
  // The same frames give the same bytes.
  const DriveCalibration again = learned_in_room(wrong);
  CHECK(again.covariance == mended.covariance);
  CHECK(again.learned.right_from_left.matrix() == mended.learned.right_from_left.matrix());
  CHECK(again.text() == mended.text());
}

TEST_CASE("drive calibration: a rig that is far off is not as good as given, even if points count as outliers",
          "[rig]") {
  const double pitch = GENERATE(0.5, 0.7, 0.9, 1.1);  // 2 to 4.4 px
  StereoCalibration wrong = room_calibration();
  wrong.right_from_left.linear() = rotation_by({pitch * kDegree, 0, 0});
  const DriveCalibration result = learned_in_room(wrong);
  INFO(pitch << " degrees: " << result.text());
  CHECK(result.verdict != CalibrationVerdict::as_good);
}

TEST_CASE("drive calibration: points that one calibration loses count against it", "[rig]") {
  const StereoCalibration truth = made_up_rig(LensModel::radial_tangential, {});
  const rig::RigUnknowns unknowns(truth);
  auto pairs = made_up_pairs(truth, 8, 0.5);
  for (rig::FramePair& pair : pairs) rig::PairAdjustment::find_motion(unknowns, pair);  // as pairs are collected
  const auto judged = [&](const Eigen::VectorXd& learned) {
    rig::UnseenViews views;
    views.add(unknowns, pointers_to(pairs), learned);
    return views;
  };
  Eigen::VectorXd learned = Eigen::VectorXd::Zero(unknowns.count());
  CHECK(judged(learned).distances(rig::UnseenViews::kLearned) == judged(learned).distances(rig::UnseenViews::kGiven));
  CHECK_FALSE(judged(learned).fall());
  CHECK_FALSE(judged(learned).rise_in_parts());
  // Far off, with hardly a point below the limit of outliers.
  learned[unknowns.first_rotation()] = 0.1;
  rig::UnseenViews views = judged(learned);
  CHECK(views.points() == 8 * 120);
  for (const double distance : views.distances(rig::UnseenViews::kLearned))
    CHECK(distance == rig::PairAdjustment::kFitLimit);
  CHECK_FALSE(views.fall());
  // A strong barrel distortion of the left lens, k1, shows no point beyond half of the image's width.
  learned.setZero();
  learned[8] = -0.5;
  REQUIRE(unknowns[8].name == "k1, left");
  REQUIRE_FALSE(LensMapping(unknowns.at(learned).left).ray({5, 5}));
  views = judged(learned);
  CHECK(views.rise_in_parts());
  const double corner = views.parts(rig::UnseenViews::kLearned)[0][0];
  CHECK((std::isnan(corner) || corner == rig::PairAdjustment::kFitLimit));
}

TEST_CASE("drive calibration: nothing is learned where a mask hides the images", "[rig]") {
  const StereoCalibration truth = room_calibration();
  const StereoRig rig = make_rig(truth);
  const Image nothing(400, 208);
  Image all = nothing;
  std::fill(all.pixels.begin(), all.pixels.end(), std::uint8_t{255});
  const auto pairs_with = [&](const StereoRig& used, const Image& left, const Image& right) {
    DriveCalibrator calibrator(truth, used);
    for (std::size_t i = 0; i < 4; ++i) {
      StereoFrame frame = room_frames()[i].view();
      frame.left_mask = left.view();
      frame.right_mask = right.view();
      calibrator.see(frame);
    }
    return calibrator.pairs();
  };
  CHECK(pairs_with(rig, all, all) > 0);
  CHECK(pairs_with(rig, nothing, {}) == 0);  // masks of the frames
  CHECK(pairs_with(rig, {}, nothing) == 0);
  // The rig's mask, of a pinhole image that shows the middle of the recorded one alone: beyond it, too.
  StereoRig narrow = make_rig(truth, 40);
  REQUIRE(narrow.left.fx > 2 * rig.left.fx);
  CHECK(pairs_with(narrow, all, all) > 0);
  narrow.left_mask = {narrow.left.width, narrow.left.height,
                      std::vector<std::uint8_t>(nothing.pixels.size(), std::uint8_t{1})};
  CHECK(pairs_with(narrow, all, all) == 0);
}

TEST_CASE("drive calibration: of a long recording every other pair is kept, the first one as well", "[rig]") {
  const StereoCalibration truth = room_calibration();
  std::size_t second = 0;  // the first frame that has moved enough
  for (int pairs = 0; pairs == 0;) {
    REQUIRE(++second < room_frames().size());
    DriveCalibrator calibrator(truth, make_rig(truth));
    calibrator.see(room_frames()[0].view());
    calibrator.see(room_frames()[second].view());
    pairs = calibrator.pairs();
  }
  const auto points_of = [&](int most_pairs) {
    DriveCalibrator calibrator(truth, make_rig(truth), most_pairs);
    for (int i = 0; i < 20; ++i) {  // twenty times the same pair
      calibrator.see(room_frames()[0].view());
      calibrator.see(room_frames()[second].view());
      calibrator.restart();
    }
    return std::pair(calibrator.pairs(), calibrator.finish().points);
  };
  const auto [pairs, points] = points_of(100);
  REQUIRE(pairs == 20);
  const auto [kept_pairs, kept_points] = points_of(10);
  CHECK(kept_pairs == 10);
  CHECK(std::abs(kept_points - points / 2) < points / 40);  // half of a pair's
}

TEST_CASE("drive calibration: without k3, where the format to write has none", "[rig]") {
  const StereoCalibration truth = made_up_rig(LensModel::radial_tangential, {-0.28, 0.07, 0.0002, 0.0001});
  StereoCalibration given = truth;
  given.right.parameters[0] += 0.01;
  const rig::RigUnknowns unknowns(given, false);
  const auto pairs = made_up_pairs(truth, 16, 0.05);
  const StereoCalibration learned = unknowns.at(rig::PairAdjustment(unknowns, pointers_to(pairs)).learn());
  CHECK(largest_displacement(truth, learned) < 0.25 * largest_displacement(truth, given));
  const TemporaryFolder folder;
  write_calibration(folder / "chain.yaml", learned, "kalibr");
  CHECK(read_calibration(folder / "chain.yaml").right.parameters == learned.right.parameters);
}

TEST_CASE("drive calibration: a camera that stands shows nothing, and says what to do", "[rig]") {
  const StereoCalibration truth = room_calibration();
  DriveCalibrator calibrator(truth, make_rig(truth));
  for (int i = 0; i < 20; ++i) calibrator.see(room_frames()[0].view());
  const DriveCalibration result = calibrator.finish();
  CHECK(result.verdict == CalibrationVerdict::cannot_show);
  CHECK(result.pairs == 0);
  CHECK_THAT(result.text(), Contains("drive past near and far objects, turn both ways"));
  const Image small(100, 80);
  CHECK_THROWS_AS(calibrator.see({0, small.view(), small.view()}), DataError);
}

TEST_CASE("calibrate: files, judgement and errors", "[cli]") {
  const TemporaryFolder folder;
  const std::string rig = folder / "rig.yaml";
  CHECK_THAT(run_well({"calibrate", small_sequence(), "-o", rig, "--json", folder / "rig.json"}).out,
             Contains("this recording cannot show it") && Contains("holds the given calibration"));
  CHECK_THAT(read_text(folder / "rig.json"), Contains("\"verdict\": \"cannot_show\""));
  run_well({"check", small_sequence(), "--quiet", "--write-calibration", folder / "given.yaml"});
  CHECK(read_text(rig) == read_text(folder / "given.yaml"));
  check_error({"calibrate", small_sequence(), "-o", rig}, 2);  // --force
  run_well({"calibrate", small_sequence(), "-o", rig, "--force", "--quiet"});
  check_error({"calibrate"}, 2);
  check_error({"calibrate", folder / "absent"}, 3);
  check_error({"calibrate", small_sequence(), "--most-frames", "1"}, 2);
}

TEST_CASE("calibrate: the rig of KITTI's raw drives is off, that of MH_01 stays as given", "[cli][real][long]") {
  const TemporaryFolder folder;
  for (const auto& [name, verdict] : {std::pair("kitti_raw_0926", "the calibration is off"),
                                      std::pair("euroc_mh_01_easy", "the calibration is as good as given")}) {
    const std::string recording = dataset_files::real_data(name);
    if (recording.empty()) continue;
    INFO(name);
    CHECK_THAT(run_program({"calibrate", recording, "-o", folder / (std::string(name) + ".yaml")}).out,
               Contains(verdict));
  }
}

TEST_CASE("run: --calibrate says what it learned and leaves it beside the results", "[cli][device]") {
  const TemporaryFolder folder;
  const std::vector<std::string> run = {"run", small_sequence(), "-o", folder / "out", "--calibrate", "--quiet"};
  CHECK_THAT(run_well(run).err, Contains("this recording cannot show it"));
  CHECK_THAT(read_text(folder / "out/rig.json"), Contains("cannot_show"));
  CHECK_THAT(read_text(folder / "out/rig.yaml"), Contains("left_model: radtan"));
  CHECK_THAT(check_error(run, 2, {"holds results"}).err, !Contains("cannot show it"));  // before it learns
}
