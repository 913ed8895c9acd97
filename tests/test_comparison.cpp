#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "dataset_files.hpp"
#include "made_up_run.hpp"
#include "output/comparison.hpp"
#include "temporary_folder.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;
using dataset_files::write_text;
using Json = nlohmann::json;

namespace {

Json compare(const std::string& output, const std::string& baseline, const std::vector<report::Peer>& peers) {
  return Json::parse(report::comparison_json(output, baseline, peers, "quadedge report"));
}

}  // namespace

TEST_CASE("comparison: a baseline and a peer are evaluated against the batch's ground truth", "[report]") {
  const TemporaryFolder folder;
  const std::string today = folder / "today";
  const auto yesterday = made_up_run(12, 0.02);
  write_batch(today, {{"street", made_up_run(12, 0.01)}, {"hall", made_up_run(8, 0.02)}});
  write_batch(folder / "yesterday", {{"street", yesterday}});
  // The peer is the ground truth in another world frame: its error is zero once aligned.
  Trajectory peer = read_tum(member_folder(today, "street") + "/groundtruth.txt");
  for (auto& pose : peer) pose.world_from_left = Eigen::Translation3d(5, 6, 7) * pose.world_from_left;
  std::filesystem::create_directories(folder / "peers");
  write_tum(folder / "peers/street.txt", peer);

  const Json json = compare(today, folder / "yesterday", {{"Other & Co", folder / "peers"}});
  CHECK(json["command"] == "quadedge report");
  CHECK(json["date"].get<std::string>().size() == 20);
  const Json &street = json["sequences"][0], &hall = json["sequences"][1];
  CHECK(street["baseline"]["frames_tracked"] == 12);
  CHECK(street["baseline"]["accuracy"]["origin_aligned"]["ape_translation_m"]["mean"] ==
        yesterday.accuracy->origin_aligned.ape_translation_m.mean);
  REQUIRE(street["systems"].size() == 2);
  CHECK(street["systems"][0]["name"] == "baseline");
  CHECK(street["systems"][1]["name"] == "Other & Co");
  CHECK(street["systems"][1]["accuracy"]["origin_aligned"]["ape_translation_m"]["max"].get<double>() < 1e-9);
  CHECK(street["systems"][1]["per_pose"]["ape_translation_m"].size() == 12);
  CHECK(street["systems"][1]["per_pose"]["rpe_translation_m"][0].is_null());
  CHECK_FALSE(hall.contains("baseline"));
  CHECK_THAT(hall["notes"][0].get<std::string>(), Contains("no hall.txt in"));
  CHECK_THROWS_WITH(compare(folder / "absent", "", {}), Contains("absent"));
  CHECK_THROWS_WITH(compare(today, folder / "peers", {}), Contains("peers"));
}

TEST_CASE("comparison: unreadable files are reported, and the other sequences are compared", "[report]") {
  const TemporaryFolder folder;
  const std::string today = folder / "today";
  write_batch(today,
              {{"truth", made_up_run(8, 0.02)}, {"good", made_up_run(12, 0.01)}, {"poses", made_up_run(9, 0.1)}});
  dataset_files::truncate(member_folder(today, "truth") + "/groundtruth.txt", 0.55);
  dataset_files::truncate(member_folder(today, "poses") + "/trajectory.txt", 0.55);
  write_text(folder / "peers/good.txt", "0 0 0 0 0 0 0 2\n");
  const Json json = compare(today, today, {{"Other", folder / "peers"}});
  CHECK_THAT(json["sequences"][0]["notes"][0].get<std::string>(), Contains("groundtruth.txt"));
  CHECK_THAT(json["sequences"][1]["notes"][0].get<std::string>(), Contains("peers/good.txt:1"));
  REQUIRE(json["sequences"][1]["systems"].size() == 1);
  CHECK(json["sequences"][2]["systems"].empty());
}
