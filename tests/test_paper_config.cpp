/// \file test_paper_config.cpp  config/paper.toml, the paper's method without extensions.
#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "data/toml_file.hpp"
#include "program.hpp"
#include "quadedge/config.hpp"

namespace {

const std::string kPaper = QUADEDGE_KERNELS "/../config/paper.toml";

}  // namespace

TEST_CASE("paper.toml: tracks a short rendered sequence, and each of its lines changes a default", "[cli][device]") {
  const TemporaryFolder folder;
  // A motion is that of a single sample, so a test of one seed would be a matter of chance: means over three.
  double explained = 0, rotation_deg = 0;
  for (const char* seed : {"1", "2", "3"}) {
    const auto run = run_program(
        {"run", small_sequence(), "-o", folder / "out", "--config", kPaper, "--seed", seed, "--quiet", "--force"});
    INFO(run.err);
    REQUIRE(run.code == 0);
    const auto report = nlohmann::json::parse(read_text(folder / "out/report.json"));
    CHECK(report["frames_tracked"] == 4);
    // A single sample's error is the depth error of its two points, 9 m^2 x 0.1 px / (184 px x 0.06 m) = 8 cm at 3 m; a
    // correct sample explains nearly all quads within 1.5 px, a wrong one does not.
    const auto& errors = report["accuracy"]["origin_aligned"];
    CHECK(errors["rpe_translation_m"]["mean"].get<double>() < 0.08);
    explained += report["counts"]["inliers"].get<double>() / report["counts"]["quads"].get<double>() / 3;
    rotation_deg += errors["rpe_rotation_deg"]["mean"].get<double>() / 3;
  }
  CHECK(explained > 0.8);
  CHECK(rotation_deg < 0.5);

  const auto lines = quadedge::data::read_toml(kPaper);
  const quadedge::Config paper = quadedge::read_config(kPaper), defaults,
                         effective = quadedge::read_config(folder / "out/config.toml");
  REQUIRE(lines.size() > 15);
  for (const auto& constant : quadedge::constants()) {
    INFO(constant.key());
    CHECK((constant.text(effective) == constant.text(paper) || constant.key() == "stereo.max_disparity" ||
           constant.key() == "seed"));
    const auto names_it = [&](const auto& line) { return line.key == constant.key(); };
    const bool is_line = std::any_of(lines.begin(), lines.end(), names_it);
    CHECK((constant.text(paper) != constant.text(defaults)) == is_line);
  }
}
