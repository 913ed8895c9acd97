/// \file test_paper_config.cpp  config/paper.toml, the paper's plain method.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <set>

#include "program.hpp"
#include "quadedge/config.hpp"
#include "report/config_toml.hpp"

namespace {

const std::string kPaper = QUADEDGE_KERNELS "/../config/paper.toml";

/// "section.key" -> value of a TOML file of plain sections, as written.
std::map<std::string, std::string> toml_values(const std::string& text) {
  std::map<std::string, std::string> values;
  std::istringstream lines(text);
  std::string section;
  for (std::string line; std::getline(lines, line);) {
    line = line.substr(0, line.find('#'));
    const auto equals = line.find('=');
    if (!line.empty() && line[0] == '[') section = line.substr(1, line.find(']') - 1) + ".";
    if (equals == std::string::npos) continue;
    const auto trimmed = [](const std::string& part) {
      const auto first = part.find_first_not_of(" \"");
      return part.substr(first, part.find_last_not_of(" \"") - first + 1);
    };
    values[section + trimmed(line.substr(0, equals))] = trimmed(line.substr(equals + 1));
  }
  return values;
}

}  // namespace

TEST_CASE("paper.toml: tracks a short rendered sequence, and each of its lines changes a default", "[cli][device]") {
  const TemporaryFolder folder;
  const auto run = run_program({"run", small_sequence(), "-o", folder / "out", "--config", kPaper, "--quiet"});
  INFO(run.err);
  REQUIRE(run.code == 0);
  const auto report = nlohmann::json::parse(read_text(folder / "out/report.json"));
  CHECK(report["frames_tracked"] == 4);
  // A single sample moves as far as the depths of its two points are off, 9 m^2 x 0.1 px / (184 px x 0.06 m) = 8 cm at
  // 3 m; that it explains nearly all quads within 1.5 px tells it from a wrong one.
  CHECK(report["accuracy"]["origin_aligned"]["rpe_translation_m"]["mean"].get<double>() < 0.08);
  CHECK(report["counts"]["inliers"].get<double>() > 0.8 * report["counts"]["quads"].get<double>());
  CHECK(report["accuracy"]["origin_aligned"]["rpe_rotation_deg"]["mean"].get<double>() < 0.5);

  const auto lines = toml_values(read_text(kPaper)), effective = toml_values(read_text(folder / "out/config.toml"));
  const auto defaults = toml_values(quadedge::report::config_toml(quadedge::Config(), "auto"));
  REQUIRE(lines.size() > 15);
  for (const auto& [key, value] : lines) {
    INFO(key << " = " << value);
    REQUIRE(effective.count(key) == 1);
    CHECK(effective.at(key) == value);
    CHECK(defaults.at(key) != value);
  }
}
