#include "background_program.hpp"

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

TEST_CASE("demo: tracks and evaluates the built-in sequence", "[cli][device]") {
  const TemporaryFolder folder;
  const auto result = run_well({"demo", "-o", folder / "demo", "--frames", "4", "--size", "320x200"});
  CHECK_THAT(result.out, Contains("4 of 4 frames") && Contains("error      ") && Contains("deg per frame (mean)"));
  CHECK_THAT(read_text(folder / "demo/config.toml"), Contains("rig_sigma_length = 0 "));  // rendered rigs are exact
  for (const char* name : {"pictures/edges_000002.png", "pictures/quads_000002.png"}) {
    CHECK(fs::file_size(folder / ("demo/" + std::string(name))) > 1000);
  }
}

TEST_CASE("demo: renders before it tracks, and only once", "[cli][device]") {
  const TemporaryFolder folder;
  const std::string cache = "XDG_CACHE_HOME='" + (folder / "cache") + "'";
  const auto demo = [&](const std::string& out, const std::string& environment) {
    return run_well({"demo", "-o", folder / out, "--frames", "3", "--size", "320x200"}, environment);
  };
  const auto first = demo("first", cache);
  const auto kernels = first.err.find("building kernels"), rendering = first.err.find("rendering 3/3");
  const auto tracking = first.err.find("room frame 3/3");
  REQUIRE((kernels != std::string::npos && rendering != std::string::npos && tracking != std::string::npos));
  CHECK((kernels < rendering && rendering < tracking));
  CHECK_THAT(first.err.substr(tracking), Contains("frames/s"));

  const auto second = demo("second", cache);
  CHECK(second.err.find("rendering") == std::string::npos);
  std::ofstream(folder / "file") << "in the way";
  const auto third = demo("third", "XDG_CACHE_HOME='" + (folder / "file/cache") + "'");
  CHECK_THAT(third.err, Contains("not cached") && Contains(folder / "file/cache"));
  for (const char* out : {"second", "third"}) {
    for (const char* name : {"/trajectory.txt", "/trajectory_kitti.txt"})
      CHECK(read_text(folder / (out + std::string(name))) == read_text(folder / ("first" + std::string(name))));
  }
}

TEST_CASE("demo: two demos that render the same images at the same time do not interfere", "[cli][device]") {
  const TemporaryFolder folder;
  const std::string environment = "XDG_CACHE_HOME='" + (folder / "cache") + "'";
  const auto demo = [&](const std::string& out) {
    return Words{"demo", "-o", folder / out, "--frames", "4", "--size", "320x200"};
  };
  BackgroundProgram one(demo("one"), folder / "log_one", environment);
  BackgroundProgram other(demo("other"), folder / "log_other", environment);
  for (auto* program : {&one, &other}) {
    program->wait_until([] { return false; });
    const int status = program->end_by(0);  // it has ended already
    CHECK((WIFEXITED(status) && WEXITSTATUS(status) == 0));
  }
  CHECK(read_text(folder / "one/trajectory.txt") == read_text(folder / "other/trajectory.txt"));
  CHECK(read_lines(folder / "one/trajectory.txt").size() == 5);
  const auto again = run_program(demo("again"), environment);
  CHECK(again.err.find("rendering") == std::string::npos);
  CHECK(read_text(folder / "again/trajectory.txt") == read_text(folder / "one/trajectory.txt"));
}

TEST_CASE("demo: after Ctrl-C it reports what was kept", "[cli][device]") {
  const TemporaryFolder folder;
  const std::string out = folder / "out", cache = folder / "cache", rendered = cache + "/quadedge/rendered";
  const std::string environment = "XDG_CACHE_HOME='" + cache + "'";
  SECTION("while rendering") {
    BackgroundProgram program({"demo", "-o", out}, folder / "log", environment);
    REQUIRE(program.wait_until([&] { return fs::exists(rendered); }));
    const int status = program.end_by(SIGINT);
    REQUIRE(WIFSIGNALED(status));
    CHECK(WTERMSIG(status) == SIGINT);
    CHECK_THAT(read_text(folder / "log"),
               Contains("before the first frame") && Contains("of 60 rendered frames are cached in " + rendered));
    CHECK_FALSE(fs::exists(out + "/config.toml"));
    CHECK_FALSE(fs::exists(out + "/trajectory.txt"));  // the next start needs no --force
  }
  SECTION("while tracking") {
    BackgroundProgram program({"demo", "-o", out, "--size", "320x200"}, folder / "log", environment);
    REQUIRE(program.wait_until([&] {
      return fs::exists(out + "/trajectory_kitti.txt") && read_lines(out + "/trajectory_kitti.txt").size() > 2;
    }));
    const int status = program.end_by(SIGINT);
    REQUIRE(WIFSIGNALED(status));
    CHECK(WTERMSIG(status) == SIGINT);
    const auto frames = read_lines(out + "/trajectory_kitti.txt").size();
    CHECK(frames < 60);
    CHECK_THAT(read_text(folder / "log"), Contains("interrupted after " + std::to_string(frames) +
                                                   " of 60 frames; results of these frames are in " + out) &&
                                              Contains(" report " + out) &&
                                              Contains("60 of 60 rendered frames are cached"));
    CHECK(read_lines(out + "/frames.csv").size() == frames + 1);
    CHECK_THAT(read_text(out + "/report.json"), Contains("\"ended_early\": \"interrupted after ") &&
                                                    Contains("\"accuracy\": {") && Contains("\"frames\": 60"));
  }
}
