/// \file test_cli_scenes.cpp  The built-in scenes and paths on the command line.
#include "program.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;

TEST_CASE("command line: every scene and path can be written to disk with exact poses", "[cli][synthetic]") {
  const TemporaryFolder folder;
  for (const std::string& scene : synthetic_scenes()) {
    for (const std::string& path : synthetic_paths()) {
      if (scene != "facade" && path != "handheld") continue;  // the other combinations add nothing
      CAPTURE(scene, path);
      const auto result = run_program({"synth", folder / "s", "--scene", scene, "--path", path, "--frames", "3",
                                       "--size", "64x33", "--seed", "9", "--force", "--quiet"});
      REQUIRE(result.code == 0);
      auto options = rendering(64, 33, 541.764 * (64.0 / 942), 3, 4);
      options.scene = scene;
      options.path = path;
      options.seed = 9;
      const SyntheticSequence sequence(options);
      const Dataset set = open_dataset(folder / "s");
      REQUIRE(set.truth.size() == 3);
      for (int i = 0; i < 3; ++i) {
        const auto& pose = set.truth[static_cast<std::size_t>(i)].world_from_left.matrix();
        CHECK((pose - sequence.world_from_left(i).matrix()).cwiseAbs().maxCoeff() < 1e-14);
        CHECK(read_grey_image(set.frames[static_cast<std::size_t>(i)].left).pixels ==
              sequence.render(i, Side::left).image.pixels);
      }
    }
  }
}

TEST_CASE("command line: options that cannot be rendered are refused with code 2, naming the limit",
          "[cli][synthetic]") {
  const TemporaryFolder folder;
  for (const std::string command : {"synth", "demo"}) {
    const auto check_refused = [&](const Words& options, const Words& words) {
      check_error(Words{command} + options + Words{command == "synth" ? "--force" : "-o", folder / "s"}, 2, words);
    };
    check_refused({"--blur", "5"}, {"blur = 5, allowed: 0 to 1.7", "path ellipse"});
    check_refused({"--blur", "49", "--path", "handheld"}, {"blur = 49", "path handheld"});
    check_refused({"--path", "drive", "--frames", "62"}, {"1 to 61", "2.8 m"});
    check_refused({"--path", "spiral"}, {"handheld", "loop"});
    check_refused({"--scene", "garden"}, {"facade"});
  }
  CHECK_FALSE(std::filesystem::exists(folder / "s"));
}
