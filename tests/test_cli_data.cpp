#include <opencv2/imgcodecs.hpp>

#include "damaged_sequence.hpp"
#include "dataset_files.hpp"
#include "program.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
namespace fs = std::filesystem;

TEST_CASE("synth: refuses an existing folder without --force", "[cli]") {
  const TemporaryFolder folder;
  const Words synth = {"synth", folder / "s", "--frames", "1", "--size", "160x100", "--quiet"};
  run_well(synth);
  check_error(synth, 2, {"--force"});
  run_well(synth + Words{"--force"});
}

TEST_CASE("check: a damaged image hides nothing of what the others say of the calibration", "[cli]") {
  const DamagedSequence sequence;
  std::filesystem::rename(sequence / "rgb", sequence / "once_left");
  std::filesystem::rename(sequence / "rgb2", sequence / "rgb");
  std::filesystem::rename(sequence / "once_left", sequence / "rgb2");
  std::ofstream(sequence.image("rgb", 1)) << "not an image";
  const auto result =
      check_error({"check", sequence.path()}, 3, {"error: ", sequence.image("rgb", 1).filename().string()});
  CHECK_THAT(result.out, Contains("warning: ") && Contains("exchanged"));
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
  const Words evaluate = {"evaluate",           "trajectory", folder / "estimate.txt",
                          folder / "truth.txt", "--json",     folder / "e.json"};
  const auto result = run_well(evaluate);
  CHECK_THAT(result.out, Contains("origin-aligned") && Contains("SE(3)-aligned"));
  CHECK_THAT(result.out, Contains("APE translation [m]       0.0200000    0.0141421    0.0244949    0.0400000"));
  CHECK_THAT(result.out, Contains("RPE translation [m]       0.0100000    0.0000000    0.0100000    0.0100000"));
  CHECK_THAT(read_text(folder / "e.json"),
             Contains("\"origin_aligned\"") && Contains("\"ape_translation_m\"") && Contains("per_pose"));
  check_error(evaluate, 2);
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
    CHECK_THAT(run_well({"evaluate", "trajectory", folder / estimate, folder / truth}).out,
               Contains(zero) && Contains("5 of 5"));
  }
  // EuRoC's CSV is timed: other times than the estimate's are no matter.
  std::ofstream csv(folder / "denser.csv");
  for (int k = 0; k < 10; ++k)
    csv << 100 + k / 2 << (k % 2 == 0 ? "000000000" : "500000000") << ",0,0," << 0.5 * k << ",1,0,0,0\n";
  csv.close();
  CHECK_THAT(run_well({"evaluate", "trajectory", folder / "timed.txt", folder / "denser.csv"}).out,
             Contains(zero) && Contains("5 of 5"));
  check_error({"evaluate", "trajectory", folder / "timed.txt", folder / "short.txt"}, 3,
              {"quadedge: ", "short.txt", "3 rows", "5"});
  CHECK_THAT(run_well({"evaluate", "trajectory", folder / "rows.txt", folder / "rows.txt", "--from-frame", "2"}).out,
             Contains("3 of "));
}

TEST_CASE("evaluate trajectory: the rows of lost frames beside frames.csv are no estimates", "[cli]") {
  // Steps of 1 m; frame 2 is lost, and its row is off by 5 m. Frame numbers count it all the same.
  const TemporaryFolder folder;
  std::string truth, rows, frames = "frame,stamp_s,status,segment\n";
  for (int k = 0; k < 6; ++k) {
    truth += "1 0 0 0 0 1 0 0 0 0 1 " + std::to_string(k) + "\n";
    rows += "1 0 0 0 0 1 0 0 0 0 1 " + std::to_string(k == 2 ? 7 : k) + "\n";
    frames += std::to_string(k) + ",0," + (k == 0 ? "first" : k == 2 ? "lost_no_consensus" : "tracked") + ",0\n";
  }
  write_text(folder / "truth.txt", truth);
  write_text(folder / "run/trajectory_kitti.txt", rows);
  write_text(folder / "run/frames.csv", frames);
  const Words evaluate = {"evaluate", "trajectory", folder / "run/trajectory_kitti.txt", folder / "truth.txt",
                          "--steps"};
  CHECK_THAT(run_well(evaluate).out, Contains("5 of 5 estimated poses") && Contains("3 right, 0 wrong, 2 lost of 5") &&
                                         Contains("RPE translation [m]       0.0000000"));
  CHECK_THAT(run_well(evaluate + Words{"--from-frame", "3"}).out,
             Contains("3 of 5 estimated poses") && Contains("2 right, 0 wrong, 0 lost of 2"));
  write_text(folder / "run/frames.csv", frames.substr(0, frames.rfind("5,0")));
  check_error(evaluate, 3, {"frames.csv", "5 frames", "6 as in"});
}

TEST_CASE(
    "evaluate trajectory: a truth that stands has no drift, and KITTI files of other lengths or with commas are "
    "refused",
    "[cli]") {
  const TemporaryFolder folder;
  std::string line, still, rows, every_third, commas;
  for (int k = 0; k < 9; ++k) {
    line += std::to_string(k) + " 0 0 " + std::to_string(k) + " 0 0 0 1\n";
    still += std::to_string(k) + " 0 0 0 0 0 0 1\n";
    const std::string row = "1 0 0 0 0 1 0 0 0 0 1 " + std::to_string(k) + "\n";
    rows += row;
    if (k % 3 == 0) every_third += row;
    for (const char c : row) commas += c == ' ' ? ',' : c;
  }
  for (const auto& [name, text] :
       {std::pair("line", line), {"still", still}, {"rows", rows}, {"third", every_third}, {"commas", commas}})
    write_text(folder / name, text);
  CHECK_THAT(run_well({"evaluate", "trajectory", folder / "line", folder / "still", "--json", folder / "e.json"}).out,
             Contains("path 0.000 m, end drift -\n"));
  CHECK_THAT(read_text(folder / "e.json"), Contains("\"end_drift_percent\": null"));
  check_error({"evaluate", "trajectory", folder / "third", folder / "rows"}, 3, {"third", "3 rows", "9", "rows"});
  check_error({"evaluate", "trajectory", folder / "rows", folder / "third"}, 3, {"9 rows", "expected 3"});
  check_error({"evaluate", "trajectory", folder / "rows", folder / "commas"}, 3,
              {"commas:1", "12 columns with commas"});
}

TEST_CASE("evaluate trajectory: EuRoC's data.csv has poses of the body, of which T_BS makes the left camera's",
          "[cli]") {
  // The body turns about z by quarters; the camera looks along the body's x axis, 1 m ahead of its origin.
  const TemporaryFolder folder;
  write_text(folder / "mav0/mocap0/data.csv",
             "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\n"
             "1000000000,0,0,0,1,0,0,0\n2000000000,0,0,0,0.70710678,0,0,0.70710678\n3000000000,0,0,0,0,0,0,1\n");
  write_text(folder / "left.txt",  // axes x: right, y: down, z: ahead
             "1 1 0 0 -0.5 0.5 -0.5 0.5\n2 0 1 0 -0.70710678 0 0 0.70710678\n3 -1 0 0 -0.5 -0.5 0.5 0.5\n");
  const Words evaluate = {"evaluate", "trajectory", folder / "left.txt", folder / "mav0/mocap0/data.csv"};
  check_error(evaluate, 3, {"data.csv", "poses of the body", "cam0/sensor.yaml", "T_BS"});
  write_text(folder / "mav0/cam0/sensor.yaml",
             "T_BS:\n  cols: 4\n  rows: 4\n  data: [0, 0, 1, 1, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, 1]\n");
  CHECK_THAT(run_well(evaluate).out,
             Contains("APE translation [m]       0.0000000    0.0000000    0.0000000    0.0000000"));
  // Another name says nothing of the frame.
  fs::copy(folder / "mav0/mocap0/data.csv", folder / "body.csv");
  const auto other = run_well({"evaluate", "trajectory", folder / "left.txt", folder / "body.csv"});
  CHECK_THAT(other.err, Contains("body.csv: taken for the left camera's poses"));
}

TEST_CASE("check: --quiet leaves the warnings of a tree, each with its recording", "[cli]") {
  const TemporaryFolder folder;
  const std::string gap = folder / "tree/gap";
  run_well({"synth", gap, "--frames", "12", "--size", "160x96"});
  fs::copy(gap, folder / "tree/sound", fs::copy_options::recursive);
  std::string listing = read_text(gap + "/rgb.txt");
  for (const char* stamp : {"0.250000000", "0.300000000", "0.350000000"}) {
    const std::string line = std::string(stamp) + " rgb/" + stamp + ".png\n";
    REQUIRE(listing.find(line) != std::string::npos);
    listing.erase(listing.find(line), line.size());
    for (const char* camera : {"/rgb/", "/rgb2/"}) fs::remove(gap + camera + stamp + ".png");
  }
  std::ofstream(gap + "/rgb.txt") << listing;
  CHECK_THAT(run_well({"check", folder / "tree", "--quiet"}).out,
             StartsWith("warning: gap: gap of 0.200 s before frame 5") && !Contains("sound"));
}
