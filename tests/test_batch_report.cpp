#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "dataset_files.hpp"
#include "made_up_run.hpp"
#include "report/batch_report.hpp"
#include "report/number_text.hpp"
#include "report/sequence_plots.hpp"
#include "temporary_folder.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;
using dataset_files::write_image;
using dataset_files::write_text;

namespace {

/// How often a text stands in another.
std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++found;
  return found;
}

/// A batch of the given made-up runs, with its summary.
void write_batch(const std::string& output, const std::vector<std::pair<std::string, report::RunRecord>>& runs) {
  std::vector<std::string> names;
  for (const auto& [name, run] : runs) {
    write_member(output, name, run);
    names.push_back(name);
  }
  write_text(output + "/summary.json", report::summary_json(report::summarise(output, names, 50)));
}

}  // namespace

TEST_CASE("number text: four digits, differences with their sign", "[report]") {
  CHECK(report::significant(0.012345678) == "0.01235");
  CHECK(report::significant(1234.5) == "1234");
  CHECK(report::significant(-2) == "-2.000");
  CHECK(report::significant(0) == "0");
  CHECK(report::significant(1e-15) == "0");
  CHECK(report::significant(std::numeric_limits<double>::quiet_NaN()) == "-");
  CHECK(report::with_difference(0.0105, 0.0117) == "0.01050 (-0.00120)");
  CHECK(report::with_difference(2, 1) == "2.000 (+1.000)");
  CHECK(report::with_difference(2, 2.0000001) == "2.000 (=)");
  CHECK(report::with_difference(2, std::numeric_limits<double>::quiet_NaN()) == "2.000");
}

TEST_CASE("batch report: thinned curves keep their extremes and their order", "[report]") {
  report::Curve curve;
  for (int i = 0; i < 1000; ++i) {
    curve.xs.push_back(i);
    curve.ys.push_back(std::sin(0.01 * i));
  }
  curve.ys[0] = std::numeric_limits<double>::quiet_NaN();
  curve.ys[357] = 9;
  curve.ys[900] = -7;
  const auto thin = report::thinned(curve, 50);
  CHECK(thin.xs.size() == 50);
  CHECK(std::is_sorted(thin.xs.begin(), thin.xs.end()));
  CHECK(std::count(thin.ys.begin(), thin.ys.end(), 9) == 1);
  CHECK(std::count(thin.ys.begin(), thin.ys.end(), -7) == 1);
  CHECK(std::none_of(thin.ys.begin(), thin.ys.end(), [](double y) { return std::isnan(y); }));
  CHECK(report::thinned(curve, 1000).xs.size() == 1000);
}

TEST_CASE("batch report: shows every sequence, compares with baseline and peers, and says what failed", "[report]") {
  const TemporaryFolder folder;
  write_batch(folder / "today", {{"street", made_up_run(12, 0.01)}, {"hall", made_up_run(8, 0.02)}});
  write_batch(folder / "yesterday", {{"street", made_up_run(12, 0.02)}});
  const std::string broken = report::member_folder(folder / "today", "broken");
  write_text(broken + "/member.json",
             report::member_json({"broken", "b", "kitti", "", 3, "calib.txt: <nothing> & so on", 1}));
  write_text(folder / "today/summary.json",
             report::summary_json(report::summarise(folder / "today", {"street", "broken", "hall"}, 50)));
  cv::imwrite(report::member_folder(folder / "today", "street") + "/pictures/thumbnail_000005.jpg",
              dataset_files::pattern(480, 300));
  // The peer is the truth itself, in another world: no error at all once it is aligned.
  Trajectory peer = read_tum(report::member_folder(folder / "today", "street") + "/groundtruth.txt");
  for (auto& pose : peer) pose.world_from_left = Eigen::Translation3d(5, 6, 7) * pose.world_from_left;
  std::filesystem::create_directories(folder / "peers");
  write_tum(folder / "peers/street.txt", peer);

  const std::string plain = report::batch_report_html(folder / "today", "", {});
  const std::string page =
      report::batch_report_html(folder / "today", folder / "yesterday", {{"Other & Co", folder / "peers"}});
  CHECK_THAT(plain, Contains("calib.txt: &lt;nothing&gt; &amp; so on") && !Contains("\n(") && !Contains("<nothing>"));
  for (const char* label :
       {"x to the right [m]", "-y upward [m]", "APE translation [m]", "APE rotation [deg]", "RPE translation [m]",
        "RPE rotation [deg]", "latency [ms]", "edges per frame", "quads per frame", "time since the first frame [s]"}) {
    INFO(label);
    CHECK(count(plain, label) >= 2);  // once per sequence that ran
  }
  CHECK(count(plain, "data:image/jpeg;base64,") == 1);
  CHECK_THAT(plain, Contains("frame 5"));
  // Nothing comes from elsewhere.
  CHECK(count(plain, "src=") == count(plain, "src=\"data:"));
  CHECK(count(plain, "href=") == count(plain, "href=\"#"));
  // Half the drift of yesterday: every error became smaller, and says by how much.
  const auto summary = report::summarise(folder / "today", {"street"}, 50);
  const auto before = report::summarise(folder / "yesterday", {"street"}, 50);
  const double now = summary.rows[0].accuracy->origin_aligned.ape_translation_m.mean;
  const double then = before.rows[0].accuracy->origin_aligned.ape_translation_m.mean;
  CHECK(now < then);
  CHECK_THAT(page, Contains(report::with_difference(now, then, "\n")));
  CHECK_THAT(page, Contains("Other &amp; Co over its 1 sequences") && Contains("no hall.txt in"));
  const std::size_t row = page.find("\u2003Other &amp; Co</td>");
  REQUIRE(row != std::string::npos);
  const std::string cells = "\u2003Other &amp; Co</td><td>12</td><td>0</td><td>0</td><td>0</td><td>0</td>";
  CHECK(page.substr(row, cells.size()) == cells);
  CHECK_THROWS_WITH(report::batch_report_html(folder / "absent", "", {}), Contains("absent"));
}

TEST_CASE("batch report: a damaged sequence, picture or peer is said, and the page shows the others", "[report]") {
  const TemporaryFolder folder;
  const std::string today = folder / "today";
  std::vector<std::pair<std::string, report::RunRecord>> runs = {{"good", made_up_run(12, 0.01)}};
  const std::vector<std::pair<std::string, std::string>> damages = {
      {"report", "report.json"}, {"frames", "frames.csv"}, {"poses", "trajectory.txt"}, {"truth", "groundtruth.txt"}};
  std::vector<std::string> names = {"good"};
  for (const auto& damage : damages) {
    runs.emplace_back(damage.first, made_up_run(8, 0.02));
    names.push_back(damage.first);
  }
  write_batch(today, runs);
  const std::string good = report::member_folder(today, "good");
  cv::imwrite(good + "/pictures/thumbnail_000005.jpg", dataset_files::pattern(48, 30));
  write_text(good + "/pictures/thumbnail_000007.jpg", "no picture");
  write_text(folder / "peers/good.txt", "0 0 0 0 0 0 0 2\n");
  for (const auto& [name, file] : damages)
    dataset_files::truncate(report::member_folder(today, name) + "/" + file, 0.55);

  const auto summary = report::summarise(today, names, 50);
  CHECK(summary.exit_code == 3);
  CHECK(summary.rows[0].status == report::MemberStatus::done);
  for (std::size_t i = 1; i <= 2; ++i) {  // what the summary itself reads
    INFO(names[i]);
    CHECK(summary.rows[i].status == report::MemberStatus::failed);
    CHECK_THAT(summary.rows[i].member.message, Contains("damaged") && Contains(damages[i - 1].second));
    CHECK_FALSE(summary.rows[i].accuracy);
  }
  const std::string page = report::batch_report_html(today, "", {{"Other", folder / "peers"}});
  for (const auto& [name, file] : damages) {
    INFO(name);
    CHECK_THAT(page, Contains("sequences/" + name + "/" + file));
  }
  CHECK_THAT(page, Contains("thumbnail_000007.jpg: no picture") && Contains("peers/good.txt:1"));
  CHECK(count(page, "data:image/jpeg;base64,") == 1);
  CHECK(count(page, "Latency by stage</text>") == 1);
  // As the other batch of a comparison they cost as little.
  CHECK_THAT(report::batch_report_html(today, today, {}), Contains("Latency by stage"));
}

TEST_CASE("batch report: stays below five megabytes for a whole benchmark", "[report]") {
  const TemporaryFolder folder;
  std::vector<std::pair<std::string, report::RunRecord>> runs;
  const auto run = made_up_run(300, 0.0001);
  for (int i = 0; i < 61; ++i) runs.emplace_back("sequence_" + std::to_string(i), run);
  write_batch(folder / "out", runs);
  for (int i = 0; i < 61; ++i) {
    cv::Mat noise(300, 480, CV_8UC3);
    cv::randu(noise, 0, 255);
    const std::string pictures = report::member_folder(folder / "out", "sequence_" + std::to_string(i)) + "/pictures/";
    for (const char* name : {"thumbnail_000100.jpg", "thumbnail_000200.jpg"}) cv::imwrite(pictures + name, noise);
  }
  const std::string page = report::batch_report_html(folder / "out", "", {});
  CHECK(page.size() <= 5'000'000);
  CHECK(page.size() > 1'000'000);
  CHECK(count(page, "Latency by stage</text>") == 61);
  CHECK_THAT(page, Contains("thinned"));
}
