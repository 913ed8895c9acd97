#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "devices.hpp"
#include "evaluation/matching_observer.hpp"
#include "program.hpp"
#include "quadedge/error.hpp"

using namespace quadedge;
using namespace quadedge::evaluation;

namespace {

SyntheticOptions small_room() {
  SyntheticOptions options;
  options.width = 320;
  options.height = 200;
  options.focal *= 320.0 / 942.0;
  options.frames = 2;
  return options;
}

/// The rendered room with a change to its rig and frames.
class ChangedRoom : public MatchingSource {
 public:
  ChangedRoom(const std::function<void(StereoRig&)>& change_rig, std::function<void(TrueFrame&)> change)
      : room_(make_rendered_source(small_room())), change_(std::move(change)), rig_(room_->rig()) {
    change_rig(rig_);
  }
  std::string name() const override { return "changed"; }
  const StereoRig& rig() const override { return rig_; }
  int frames() const override { return 1; }
  TrueFrame load(int number) const override {
    TrueFrame frame = room_->load(number);
    change_(frame);
    return frame;
  }

 private:
  std::unique_ptr<MatchingSource> room_;
  std::function<void(TrueFrame&)> change_;
  StereoRig rig_;
};

template <class Values>
void mirror(Values& values, int width) {
  for (auto row = values.begin(); row != values.end(); row += width) std::reverse(row, row + width);
}

FilterCounts last_row(const MatchingSource& source) {
  Device device("auto", kept_programs());
  const auto summary = summarise({evaluate_matching(source, device, {})});
  return summary.stereo.back().row.all;
}

const FilterCounts& plain() {
  static const FilterCounts counts = last_row(*make_rendered_source([] {
    auto options = small_room();
    options.frames = 1;
    return options;
  }()));
  return counts;
}

}  // namespace

TEST_CASE("Most final stereo edges of the rendered room are true", "[matching][device]") {
  CHECK(plain().pool > 5000);
  CHECK(plain().precision() > 0.9);
  CHECK(plain().recall() > 0.6);
}

TEST_CASE("Ground truth that is off by two pixels leaves almost no true edges", "[matching][device]") {
  const auto wrong = last_row(ChangedRoom([](StereoRig&) {},
                                          [](TrueFrame& frame) {
                                            for (auto* map : {&frame.truth.left, &frame.truth.right}) {
                                              for (auto& value : map->nearness) value += 2;
                                            }
                                          }));
  CHECK(wrong.candidates > 5000);
  CHECK(wrong.precision() < 0.05);
}

TEST_CASE("Swapping left and right hardly changes the result", "[matching][device]") {
  const auto swapped = last_row(ChangedRoom(
      [](StereoRig& rig) {
        rig.left.cx = rig.left.width - 1 - rig.left.cx;
        rig.right.cx = rig.right.width - 1 - rig.right.cx;
      },
      [](TrueFrame& frame) {
        std::swap(frame.frame.left, frame.frame.right);
        std::swap(frame.truth.left, frame.truth.right);
        for (auto* image : {&frame.frame.left, &frame.frame.right}) mirror(image->pixels, image->width);
        for (auto* map : {&frame.truth.left, &frame.truth.right}) mirror(map->nearness, map->width);
      }));
  CHECK(swapped.precision() == Approx(plain().precision()).margin(0.02));
  CHECK(swapped.recall() == Approx(plain().recall()).margin(0.03));
}

TEST_CASE("The reference has no filters to observe and is refused", "[matching]") {
  Device device("reference");
  CHECK_THROWS_AS(evaluate_matching(*make_rendered_source(small_room()), device, {}), UsageError);
}

TEST_CASE("evaluate matching prints all tables of a sequence and writes them as JSON", "[matching][device][cli]") {
  const TemporaryFolder folder;
  const auto result = run_program({"evaluate", "matching", small_sequence(), "--frames", "2", "--json",
                                   folder / "m.json", "--quiet", "--stereo.sift_max", "400"});
  REQUIRE(result.code == 0);
  for (const char* text :
       {"Table 1", "Table 2: in time, left", "Table 2: in time, right", "Table 3", "disparity error"}) {
    CHECK(result.out.find(text) != std::string::npos);
  }
  const auto json = nlohmann::json::parse(read_text(folder / "m.json"));
  REQUIRE(json["pairs"].size() == 1);
  CHECK(json["pairs"][0]["name"] == "room4");
  CHECK(json["pairs"][0]["disparity_error_px"]["median"].get<double>() < 0.3);
  const auto& pooled = json["pooled"];
  REQUIRE(pooled["stereo"].size() == 13);
  CHECK(pooled["stereo"][0]["recall"] == 1.0);
  CHECK(pooled["stereo"][12]["ambiguity_mean"] == 0.0);
  CHECK(pooled["stereo"][12]["precision"].get<double>() > 0.9);
  CHECK(pooled["temporal_left"].size() == 9);
  CHECK(pooled["temporal_right"].size() == 9);
  CHECK(pooled["quads"]["precision"].get<double>() > 0.8);
  REQUIRE(pooled["constraints"].size() == 7);
  CHECK(pooled["constraints"][0]["recall"] == 1.0);
  // The distributions count the same candidates as the tables: those of paired edges before a filter, after the
  // previous one.
  const auto& cues = pooled["distributions"];
  for (const auto& cue : cues) {
    const auto total = [&](const char* kind) {
      long long sum = cue[kind]["below"].get<long long>() + cue[kind]["above"].get<long long>();
      for (const auto& count : cue[kind]["bins"]) sum += count.get<long long>();
      return sum;
    };
    const int order = cue["order"].get<int>();
    if (cue["table"] != "stereo" || order < 2) continue;
    INFO(cue["cue"]);
    CHECK(total("veridical") + total("other") ==
          pooled["stereo"][static_cast<std::size_t>(order - 1)]["kept"].get<long long>());
  }
  CHECK(cues.size() == 8 + 6 + 6 + 5);
  CHECK(pooled["stereo_edges"]["correct"].get<int>() > 10 * pooled["stereo_edges"]["inaccurate"].get<int>());
  CHECK(json["pairs"][0]["counts"][1]["status"] == "tracked");
  CHECK(json["pairs"][0]["counts"][1]["rotation_error_deg"].get<double>() < 0.1);
  // Each filter reads the previous filter's list, so no true candidate can return before the refinement.
  for (std::size_t row = 1; row < 8; ++row) {
    CHECK(pooled["stereo"][row]["recall"].get<double>() <= pooled["stereo"][row - 1]["recall"].get<double>());
    CHECK(pooled["stereo"][row]["kept"].get<long long>() < pooled["stereo"][row - 1]["kept"].get<long long>());
  }
}

TEST_CASE("evaluate matching draws, refuses to overwrite files, and reports overflows", "[matching][device][cli]") {
  const TemporaryFolder folder;
  const auto result =
      run_program({"evaluate", "matching", small_sequence(), "room", "--size", "320x200", "--frames", "2", "--draw",
                   folder / "drawn", "--json", folder / "m.json", "--stereo.ncc_min", "0.55", "--quiet"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  for (const char* title : {"=== room4:", "=== room:", "=== all:"}) CHECK(result.out.find(title) != std::string::npos);
  CHECK(std::filesystem::exists(folder / "drawn/room4_correct.png"));
  CHECK(std::filesystem::exists(folder / "drawn/room_wrong.png"));
  CHECK(nlohmann::json::parse(read_text(folder / "m.json"))["config_changed"]["stereo.ncc_min"] == "0.55");

  const auto cut = run_program({"evaluate", "matching", "room", "--size", "320x200", "--frames", "1",
                                "--edges.max_edges", "5000", "--json", folder / "cut.json"});
  CHECK(cut.code == 0);
  CHECK(cut.err.find("max_edges") != std::string::npos);
  CHECK(read_text(folder / "cut.json").find("max_edges were dropped") != std::string::npos);

  const auto again = run_program({"evaluate", "matching", "room", "--json", folder / "m.json"});
  CHECK(again.code == 2);
  CHECK(again.err.find("--force") != std::string::npos);
  CHECK(run_program({"evaluate", "matching", "room", "--draw", folder / "drawn"}).code == 2);
}

TEST_CASE("A stricter threshold keeps less", "[matching][device][cli]") {
  const TemporaryFolder folder;
  const auto recall = [&](const std::string& degrees) {
    const std::string file = folder / (degrees + ".json");
    REQUIRE(run_program({"evaluate", "matching", "room", "--frames", "1", "--size", "320x200", "--stereo.orientation",
                         degrees, "--json", file, "--quiet"})
                .code == 0);
    return nlohmann::json::parse(read_text(file))["pooled"]["stereo"].back()["recall"].get<double>();
  };
  CHECK(recall("2") < recall("10"));
}

TEST_CASE("evaluate matching refuses input that it cannot evaluate", "[matching][cli]") {
  const TemporaryFolder folder;
  CHECK(run_program({"evaluate", "matching", folder / "nothing"}).code == 3);
  const TemporaryFolder blind;
  std::filesystem::copy(small_sequence(), blind / "room4", std::filesystem::copy_options::recursive);
  std::filesystem::remove_all(blind / "room4/depth");
  const auto result = run_program({"evaluate", "matching", blind / "room4"});
  CHECK(result.code == 3);
  CHECK(result.err.find("no ground truth") != std::string::npos);
}
