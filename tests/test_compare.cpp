#include <nlohmann/json.hpp>

#include "benchmark/compare_frontends.hpp"
#include "benchmark/variant_comparison.hpp"
#include "frontends.hpp"
#include "program.hpp"

using Catch::Matchers::Contains;
using Json = nlohmann::json;
using namespace quadedge;
namespace fs = std::filesystem;

namespace {

Words compare_arguments(const Words& more) {
  return Words{"compare", "--size", "160x100", "--edges", "0", "--repetitions", "1", "--quiet"} + more;
}

/// Runs the small sequence with a folder of saved variants.
ProgramResult run_with_saved(const std::string& configuration, const std::string& out, const Words& more = {}) {
  return run_program(Words{"run", small_sequence(), "-o", out, "--frames", "0:2", "--quiet"} + more,
                     "XDG_CONFIG_HOME='" + configuration + "'");
}

}  // namespace

TEST_CASE("compare: all variants of a stage are measured, agree, and the best are saved for run", "[cli][device]") {
  const TemporaryFolder folder;
  const auto result =
      run_well(compare_arguments({"--stage", "edge_detection", "--save", "--json", folder / "compare.json"}),
               "XDG_CONFIG_HOME='" + folder.path() + "'");
  const Json comparison = Json::parse(read_text(folder / "compare.json"));
  REQUIRE(comparison["stages"].size() == 1);
  const auto& stage = comparison["stages"][0];
  CHECK(stage["stage"] == "edge_detection");
  REQUIRE(stage["variants"].size() == 3);
  int defaults = 0;
  for (const auto& variant : stage["variants"]) {
    for (const char* key :
         {"name", "default", "agrees", "median_ms", "p10_ms", "p90_ms", "ratio_to_default", "ratio_p90"}) {
      INFO(key);
      CHECK(variant.contains(key));
    }
    CHECK(variant["agrees"] == true);
    CHECK(variant["median_ms"].get<double>() > 0);
    if (variant["default"] == true) {
      ++defaults;
      CHECK(variant["ratio_to_default"] == 1);
    }
  }
  CHECK(defaults == 1);

  const Device device;
  const std::string file = folder / ("quadedge/" + bench::variants_file_name(device.info()));
  REQUIRE(fs::exists(file));
  CHECK(Json::parse(read_text(file))["variants"]["edge_detection"] == stage["best"]);
  CHECK_THAT(result.out, Contains(file));
  REQUIRE(run_with_saved(folder.path(), folder / "out").code == 0);
  CHECK(Json::parse(read_text(folder / "out/report.json"))["variants"]["edge_detection"] == stage["best"]);
}

TEST_CASE("compare: a stage that only copies the input has no time", "[cli][device]") {
  const TemporaryFolder folder;  // the built-in sequence has no distortion
  CHECK_THAT(run_well(compare_arguments({"--stage", "undistortion", "--json", folder / "compare.json"})).out,
             Contains("this input never runs the stage"));
  CHECK(Json::parse(read_text(folder / "compare.json"))["stages"][0]["variants"][0]["median_ms"].is_null());
}

TEST_CASE("compare: run uses saved variants, and the command line and --config override them", "[cli][device]") {
  const TemporaryFolder folder;
  const Device device;
  bench::write_variants_file(folder / ("quadedge/" + bench::variants_file_name(device.info())), device.info(),
                             {{"edge_detection", "tile64"}, {"sift", "cells"}, {"patches", "lanes"}});
  std::ofstream(folder / "config.toml") << "variant = [\"sift=edge\"]\n";
  const auto variants = [&](const std::string& name, const Words& more) {
    const auto run = run_with_saved(folder.path(), folder / name, more);
    INFO(run.err);
    REQUIRE(run.code == 0);
    return Json::parse(read_text(folder / (name + "/report.json")))["variants"];
  };
  auto found = variants("saved", {});
  CHECK(found["edge_detection"] == "tile64");
  CHECK(found["sift"] == "cells");
  CHECK(found["patches"] == "lanes");
  CHECK(variants("typed", {"--variant", "edge_detection=strip"})["edge_detection"] == "strip");
  found = variants("configured", {"--config", folder / "config.toml"});
  CHECK(found["sift"] == "edge");
  CHECK(found["edge_detection"] == "tile64");
}

TEST_CASE("compare: run refuses an invalid variants file, or another device's, by name", "[cli][device]") {
  const Device device;
  const auto refused = [&](const std::string& text, const std::string& reason) {
    const TemporaryFolder folder;
    const std::string file = folder / ("quadedge/" + bench::variants_file_name(device.info()));
    fs::create_directories(fs::path(file).parent_path());
    std::ofstream(file) << text;
    const auto run = run_with_saved(folder.path(), folder / "out");
    INFO(run.err);
    CHECK(run.code == 2);
    CHECK_THAT(run.err, Contains(file) && Contains(reason) && Contains("compare --save"));
  };
  refused("no JSON", "is not a file of kernel variants");
  Json good = {{"content", "quadedge kernel variants"},
               {"schema", 1},
               {"device",
                {{"name", device.info().name}, {"platform", device.info().platform}, {"driver", device.info().driver}}},
               {"variants", {{"edge_detection", "tile64"}}}};
  Json changed = good;
  changed["device"]["name"] = "another device";
  refused(changed.dump(), "another device");
  changed = good;
  changed["variants"]["edge_detection"] = "no such variant";
  refused(changed.dump(), "no such variant");
  changed = good;
  changed["content"] = "something else";
  refused(changed.dump(), "does not contain kernel variants");
  changed = good;
  changed["schema"] = 99;
  refused(changed.dump(), "99");
}

TEST_CASE("compare: a variant with a different result is refused and never saved as the best", "[cli][device]") {
  const TemporaryFolder folder;
  fs::copy(QUADEDGE_KERNELS, folder / "kernels");
  // In all but one form every patch counts as flat and has no similarity.
  const std::string kernel = read_text(folder / "kernels/patches.cl");
  REQUIRE(kernel.find("kFlatPatchContrast") != std::string::npos);
  const std::string text = "#ifdef GROUP\n#define kFlatPatchContrast 1e30f\n#endif\n" + kernel;
  std::ofstream(folder / "kernels/patches.cl") << text;
  const auto result = run_program(
      compare_arguments({"--stage", "patches", "--json", folder / "compare.json", "--kernels", folder / "kernels"}));
  INFO(result.err << result.out);
  CHECK(result.code == 1);
  CHECK_THAT(result.out, Contains("REFUSED: differs from the reference at patches: "));
  const Json stage = Json::parse(read_text(folder / "compare.json"))["stages"][0];
  for (const auto& variant : stage["variants"]) {
    CHECK(variant["agrees"] == (variant["name"] == "edge"));
    CHECK(variant["median_ms"].is_null() == (variant["name"] != "edge"));
  }
  CHECK(stage["best"] != "lanes");
}

TEST_CASE("compare: the best variant agrees and is clearly faster than the default") {
  const auto variant = [](const std::string& name, bool by_default, bool agrees, double ratio) {
    bench::VariantResult result;
    result.name = name;
    result.is_default = by_default;
    result.agrees = agrees;
    result.median_ms = result.ratio_to_default = ratio;
    result.ratio_p90 = 1.1 * ratio;
    return result;
  };
  bench::StageResult stage;
  stage.variants = {variant("default", true, true, 1), variant("same", false, true, 0.98),
                    variant("wrong", false, false, 0.1)};
  CHECK(stage.best() == "default");
  stage.variants.push_back(variant("fast", false, true, 0.8));
  stage.variants.push_back(variant("faster", false, true, 0.7));
  CHECK(stage.best() == "faster");
  stage.variants.push_back(variant("noisy", false, true, 0.6));
  stage.variants.back().ratio_p90 = 1.05;  // slower than the default in one of ten repetitions
  CHECK(stage.best() == "faster");
}

TEST_CASE("compare: the first difference names stage, edge and value") {
  frontend::FrontendOutput a;
  for (int i = 0; i < 5; ++i) {
    a.left_edges.x.push_back(static_cast<float>(i));
    a.current.ncc.push_back(0.5F);
    a.quads.competing_clusters.push_back(i);
  }
  CHECK(frontend::first_difference(a, a).empty());
  auto b = a;
  b.quads.competing_clusters[3] = 7;
  CHECK(frontend::first_difference(a, b) == "temporal_match, quad 3: competing clusters is 3 instead of 7");
  b.current.ncc.pop_back();
  CHECK(frontend::first_difference(a, b) ==
        "stereo_mutual, stereo edge of the second frame: 5 instead of 4 values of NCC");
  b.left_edges.x[1] = 1.25F;
  CHECK(frontend::first_difference(a, b) == "edge_detection, left edge 1: x is 1 instead of 1.25");
}
