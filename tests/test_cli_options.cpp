#include "on_terminal.hpp"

using Catch::Matchers::Contains;

TEST_CASE("command line: every command's help shows examples, and lists the scenes and paths that it renders",
          "[cli]") {
  for (const std::string command : {"run", "demo", "edges", "synth", "check", "devices", "variants"})
    CHECK_THAT(run_well({command, "--help"}).out, Contains("Examples:\n") && Contains("quadedge " + command));
  CHECK_THAT(run_well({"evaluate", "trajectory", "--help"}).out,
             Contains("Examples:") && Contains("ESTIMATE") && Contains("--from-frame"));
  CHECK_THAT(run_well({"--help"}).out, Contains("evaluate") && Contains("Exit codes"));
  for (const std::string command : {"synth", "demo", "bench"})
    CHECK_THAT(run_well({command, "--help"}).out, Contains("facade") && Contains("handheld"));
  CHECK_THAT(run_well({"variants"}).out, Contains("undistortion") && Contains("item64") && Contains("cpu"));
}

TEST_CASE("command line: a dumb terminal gets no escape codes", "[cli]") {
  const TemporaryFolder folder;
  const Words run = {"run", small_sequence(), "--device", "reference",   "--frames",
                     "0:1", "--force",        "-o",       folder / "out"};
  CHECK_THAT(run_on_terminal(run, 80, "TERM=xterm"), Contains("\x1b[K") && Contains("frame 1/1"));
  for (const char* environment : {"TERM=dumb", "-u TERM"})
    CHECK_THAT(run_on_terminal(run, 80, environment), !Contains("\x1b") && Contains("frame 1/1"));
}

TEST_CASE("command line: invalid use ends with code 2 and names the error", "[cli]") {
  check_error({}, 2);
  check_error({"run"}, 2);
  check_error({"evaluate"}, 2);
  check_error({"rnu", "--help"}, 2);
  check_error({"rnu", "x"}, 2, {"unknown command 'rnu'; did you mean 'run'?"});
  check_error({"evaluate", "trajctory"}, 2, {"'trajctory'; did you mean 'trajectory'?"});
  CHECK_THAT(check_error({"no-such-command"}, 2, {"unknown command 'no-such-command'"}).err, !Contains("mean"));
  check_error({"run", "x", "--no-such-option"}, 2, {"--no-such-option"});
  check_error({"run", "x", "--ouptut", "y"}, 2, {"--ouptut", "did you mean '--output'?"});
  check_error({"edges", "x.png", "--edges.sigma", "wide"}, 2, {"edges.sigma", "wide"});
  check_error({"edges", "x.png", "--edges.sigma", ""}, 2, {"edges.sigma", "not a number"});
  for (const std::string seed : {"-1", "010", "0x10", "18446744073709551616", "1.5", ""})
    check_error({"edges", "x.png", "--seed", seed}, 2, {"seed"});
  check_error({"edges", "x.png", "--stereo.ncc_min", "1.5"}, 2, {"stereo.ncc_min", "1.5", "0.01 to 1"});
  check_error({"run", "x", "--format", "betamax"}, 2, {"betamax", "kitti"});
  check_error({"run", "x", "--frames", "7"}, 2, {"A:B"});
  check_error({"run", "x", "--frames", "3:z"}, 2);
  check_error({"run", "x", "--min-tracked", "150"}, 2);
  check_error({"demo", "--size", "320"}, 2);
  check_error({"demo", "--size", "320x200x3"}, 2);
  check_error({"demo", "--variant", "cooking=fast"}, 2, {"cooking", "undistortion"});
  check_error({"demo", "--variant", "undistortion"}, 2);
  for (const Words& bench : {Words{"--frames", "0"},
                             {"--warm-up", "-1"},
                             {"--edges", "-2"},
                             {"--noise", "-1"},
                             {"--compare", "old.json"},
                             {"somewhere", "--size", "64x48"}})
    check_error(Words{"bench"} + bench, 2);
  for (const Words& compare :
       {Words{"--stage", "none"}, {"--repetitions", "0"}, {"--edges", "-1"}, {"--device", "reference"}})
    check_error(Words{"compare"} + compare, 2);
}

TEST_CASE("configuration file: what is wrong in it ends with code 2 and names file, line and key", "[cli]") {
  const TemporaryFolder folder;
  const Words edges = {"edges", "x.png", "--config"};
  for (const auto& [text, words] :
       {std::pair<std::string, Words>{"[stereo]\nncc_minimum = 0.7\n", {"stereo.ncc_minimum"}},
        {"IMAGE = \"other.png\"\n", {}},
        {"force = 1\n", {"config.toml:1: force: expected true or false, found 1"}}}) {
    std::ofstream(folder / "config.toml") << text;
    check_error(edges + Words{folder / "config.toml"}, 2, words + Words{"config.toml"});
  }
  check_error(edges + Words{folder / "absent.toml"}, 2, {"absent.toml"});
  check_error(edges + Words{folder.path()}, 2);
}

TEST_CASE("configuration file: the command line overrides the environment, which overrides the file", "[cli]") {
  // The message about the unknown device shows which setting counts.
  const TemporaryFolder folder;
  const std::string file = folder / "config.toml", environment = "QUADEDGE_DEVICE=from-environment";
  std::ofstream(file) << "device = \"from-file\"\n[edges]\nsigma = 3\n";
  check_error({"demo", "--config", file}, 4, {"from-file", "0: "});  // and a list of the devices
  check_error({"demo", "--config", file}, 4, {"from-environment"}, environment);
  check_error({"demo", "--config", file, "--device", "from-command-line"}, 4, {"from-command-line"}, environment);
  // Values in the file that are overridden must be valid all the same.
  check_error({"edges", folder / "absent.png", "--config", file, "--edges.sigma", "2"}, 3, {"absent.png"});
  check_error({"edges", folder / "absent.png", "--config", file, "--edges.sigma", "1000"}, 2);
  std::ofstream(file) << "[edges]\nsigma = 1000  # far out of range\n";
  check_error({"edges", folder / "absent.png", "--config", file, "--edges.sigma", "2"}, 2,
              {"config.toml:2: edges.sigma: expected 0.5 to 8, found 1000"});
}
