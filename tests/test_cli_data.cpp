#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "damaged_sequence.hpp"
#include "program.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
namespace fs = std::filesystem;

namespace {

/// Expects only a message and code 3: no crash, and no output folder for data that cannot be opened.
void check_refused(const ProgramResult& result, const std::string& named) {
  CHECK(result.code == 3);
  CHECK_THAT(result.err, Contains("quadedge: ") && Contains(named));
}

}  // namespace

TEST_CASE("synth: writes a sequence that passes check", "[cli]") {
  const auto check = run_program({"check", small_sequence()});
  INFO(check.out + check.err);
  CHECK(check.code == 0);
  CHECK_THAT(check.out,
             Contains("eth3d-slam") && Contains("320") && Contains("200") && Contains("0 errors, 0 warnings"));
}

TEST_CASE("synth: refuses an existing folder without --force", "[cli]") {
  const TemporaryFolder folder;
  const std::vector<std::string> synth = {"synth", folder / "s", "--frames", "1", "--size", "160x100", "--quiet"};
  CHECK(run_program(synth).code == 0);
  const auto again = run_program(synth);
  CHECK(again.code == 2);
  CHECK_THAT(again.err, Contains("--force"));
  auto forced = synth;
  forced.push_back("--force");
  CHECK(run_program(forced).code == 0);
}

TEST_CASE("bad data: an empty or missing folder is refused by name", "[cli]") {
  const TemporaryFolder folder;
  check_refused(run_program({"run", folder.path()}), folder.path());
  check_refused(run_program({"run", folder / "absent"}), "absent");
  CHECK(run_program({"check", folder.path()}).code == 3);
}

TEST_CASE("check: a damaged image hides nothing of what the others say of the calibration", "[cli]") {
  const DamagedSequence sequence;
  std::filesystem::rename(sequence / "rgb", sequence / "once_left");
  std::filesystem::rename(sequence / "rgb2", sequence / "rgb");
  std::filesystem::rename(sequence / "once_left", sequence / "rgb2");
  std::ofstream(sequence.image("rgb", 1)) << "not an image";
  const auto result = run_program({"check", sequence.path()});
  CHECK(result.code == 3);
  CHECK_THAT(result.err, Contains("error: ") && Contains(sequence.image("rgb", 1).filename().string()));
  CHECK_THAT(result.out, Contains("warning: ") && Contains("exchanged"));
}

TEST_CASE("edges: a file that is not an image is refused by name", "[cli]") {
  const TemporaryFolder folder;
  std::ofstream(folder / "text.png") << "not an image";
  check_refused(run_program({"edges", folder / "text.png"}), "text.png");
}

TEST_CASE("evaluate trajectory: known errors are printed for both alignments", "[cli]") {
  // Straight line along z, estimate 1 % too long: after alignment at the origin pose k has a translation error of 0.01
  // k.
  const TemporaryFolder folder;
  std::ofstream truth(folder / "truth.txt"), estimate(folder / "estimate.txt");
  for (int k = 0; k < 5; ++k) {
    truth << k << " 0 0 " << k << " 0 0 0 1\n";
    estimate << k << " 0 0 " << 1.01 * k << " 0 0 0 1\n";
  }
  truth.close(), estimate.close();
  const auto result = run_program(
      {"evaluate", "trajectory", folder / "estimate.txt", folder / "truth.txt", "--json", folder / "e.json"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK_THAT(result.out, Contains("origin-aligned") && Contains("SE(3)-aligned"));
  CHECK_THAT(result.out, Contains("APE translation [m]       0.0200000    0.0141421    0.0244949    0.0400000"));
  CHECK_THAT(result.out, Contains("RPE translation [m]       0.0100000    0.0000000    0.0100000    0.0100000"));
  CHECK_THAT(read_text(folder / "e.json"),
             Contains("\"origin_aligned\"") && Contains("\"ape_translation_m\"") && Contains("per_pose"));
  const auto again = run_program(
      {"evaluate", "trajectory", folder / "estimate.txt", folder / "truth.txt", "--json", folder / "e.json"});
  CHECK(again.code == 2);
}

TEST_CASE("evaluate trajectory: KITTI rows are matched by number, or with timed poses one row per pose", "[cli]") {
  const TemporaryFolder folder;
  std::ofstream rows(folder / "rows.txt"), timed(folder / "timed.txt"), short_rows(folder / "short.txt");
  for (int k = 0; k < 5; ++k) {
    const std::string row = "1 0 0 0 0 1 0 0 0 0 1 " + std::to_string(k) + "\n";
    rows << row;
    if (k < 3) short_rows << row;
    timed << 100 + k << " 0 0 " << k << " 0 0 0 1\n";
  }
  rows.close(), timed.close(), short_rows.close();
  const std::string zero = "APE translation [m]       0.0000000    0.0000000    0.0000000    0.0000000";
  for (const auto& [estimate, truth] : {std::pair<std::string, std::string>{"rows.txt", "rows.txt"},
                                        {"rows.txt", "timed.txt"},
                                        {"timed.txt", "rows.txt"},
                                        {"timed.txt", "timed.txt"}}) {
    const auto result = run_program({"evaluate", "trajectory", folder / estimate, folder / truth});
    INFO(estimate + " " + truth + result.err);
    CHECK(result.code == 0);
    CHECK_THAT(result.out, Contains(zero) && Contains("5 of 5"));
  }
  // EuRoC's CSV is timed: other times than the estimate's are no matter.
  std::ofstream csv(folder / "denser.csv");
  for (int k = 0; k < 10; ++k)
    csv << 100 + k / 2 << (k % 2 == 0 ? "000000000" : "500000000") << ",0,0," << 0.5 * k << ",1,0,0,0\n";
  csv.close();
  const auto denser = run_program({"evaluate", "trajectory", folder / "timed.txt", folder / "denser.csv"});
  INFO(denser.err);
  CHECK_THAT(denser.out, Contains(zero) && Contains("5 of 5"));
  const auto mismatch = run_program({"evaluate", "trajectory", folder / "timed.txt", folder / "short.txt"});
  check_refused(mismatch, "short.txt");
  CHECK_THAT(mismatch.err, Contains("3 rows") && Contains("5"));
  const auto late =
      run_program({"evaluate", "trajectory", folder / "rows.txt", folder / "rows.txt", "--from-frame", "2"});
  CHECK_THAT(late.out, Contains("3 of "));
}

TEST_CASE("check: --quiet leaves the warnings of a tree, each with its recording", "[cli]") {
  const TemporaryFolder folder;
  const std::string gap = folder / "tree/gap";
  REQUIRE(run_program({"synth", gap, "--frames", "12", "--size", "160x96"}).code == 0);
  fs::copy(gap, folder / "tree/sound", fs::copy_options::recursive);
  std::string listing = read_text(gap + "/rgb.txt");
  for (const char* stamp : {"0.250000000", "0.300000000", "0.350000000"}) {
    const std::string line = std::string(stamp) + " rgb/" + stamp + ".png\n";
    REQUIRE(listing.find(line) != std::string::npos);
    listing.erase(listing.find(line), line.size());
    for (const char* camera : {"/rgb/", "/rgb2/"}) fs::remove(gap + camera + stamp + ".png");
  }
  std::ofstream(gap + "/rgb.txt") << listing;
  const auto result = run_program({"check", folder / "tree", "--quiet"});
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK_THAT(result.out, StartsWith("warning: gap: gap of 0.200 s before frame 5") && !Contains("sound"));
}
