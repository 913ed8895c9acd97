/// \file test_paper_preset.cpp  --preset paper: the whole method on rendered sequences.
#include <nlohmann/json.hpp>

#include "data/toml_file.hpp"
#include "program.hpp"

using namespace quadedge;

TEST_CASE("paper preset: each of its lines changes a default, and none has another effect", "[cli]") {
  const Config paper = read_preset("paper"), defaults;
  CHECK(paper.is_paper());
  const auto lines = data::read_preset("paper");
  REQUIRE(lines.size() > 12);
  for (const auto& constant : constants()) {
    INFO(constant.key());
    const bool is_line =
        std::any_of(lines.begin(), lines.end(), [&](const auto& line) { return line.key == constant.key(); });
    CHECK((constant.text(paper) != constant.text(defaults)) == is_line);
  }
}

TEST_CASE("paper preset: tracks a rendered sequence, says whose method it is, and refuses loops", "[cli][device]") {
  const TemporaryFolder folder;
  const auto track = [&](const Words& options) {
    const Words run{"run", small_sequence(), "-o", folder / "out", "--preset", "paper", "--quiet", "--force"};
    return run_program(run + options);
  };
  const auto errors_of = [&] {
    const auto report = nlohmann::json::parse(read_text(folder / "out/report.json"));
    CHECK(report["frames_tracked"] == 4);
    return report["accuracy"]["origin_aligned"];
  };
  const auto plain = track({});
  INFO(plain.err);
  REQUIRE(plain.code == 0);
  CHECK_THAT(plain.out, Catch::Contains("method     the paper's own") && !Catch::Contains("least squares added"));
  const auto of_samples = errors_of();
  // A sample's error is the depth error of its two points, 9 m^2 x 0.1 px / (184 px x 0.06 m) = 8 cm at 3 m.
  CHECK(of_samples["rpe_translation_m"]["mean"].get<double>() < 0.08);
  CHECK(of_samples["rpe_rotation_deg"]["mean"].get<double>() < 1);
  const std::string poses = read_text(folder / "out/trajectory.txt");
  REQUIRE(track({}).code == 0);
  CHECK(read_text(folder / "out/trajectory.txt") == poses);

  const auto fitted = track({"--pose.refine", "true"});
  CHECK_THAT(fitted.out, Catch::Contains("with least squares added"));
  CHECK(errors_of()["rpe_translation_m"]["mean"].get<double>() <
        0.3 * of_samples["rpe_translation_m"]["mean"].get<double>());

  const auto loops = track({"--loops"});
  CHECK(loops.code == 2);
  CHECK_THAT(loops.err, Catch::Contains("the paper's method has no map"));
}
