#include <catch2/catch.hpp>
#include <fstream>

#include "on_terminal.hpp"
#include "temporary_folder.hpp"

using Catch::Matchers::Contains;

TEST_CASE("command line: every command's help shows two examples", "[cli]") {
  for (const std::string command : {"run", "demo", "edges", "synth", "check", "devices", "variants"}) {
    const auto result = run_program({command, "--help"});
    INFO(command);
    CHECK(result.code == 0);
    const auto examples = result.out.find("Examples:");
    REQUIRE(examples != std::string::npos);
    const auto first = result.out.find("quadedge ", examples);
    REQUIRE(first != std::string::npos);
    CHECK(result.out.find("quadedge ", first + 1) != std::string::npos);
  }
  const auto evaluate = run_program({"evaluate", "trajectory", "--help"});
  CHECK(evaluate.code == 0);
  CHECK_THAT(evaluate.out, Contains("Examples:") && Contains("ESTIMATE") && Contains("--from-frame"));
  CHECK_THAT(run_program({"--help"}).out, Contains("evaluate") && Contains("Exit codes"));
}

TEST_CASE("command line: help and version are commands too", "[cli]") {
  for (const std::vector<std::string>& command : {std::vector<std::string>{}, {"run"}, {"evaluate", "trajectory"}}) {
    auto words = command, options = command;
    words.insert(words.begin(), "help");
    options.push_back("--help");
    const auto result = run_program(words);
    CHECK(result.code == 0);
    CHECK(result.out == run_program(options).out);
    CHECK_THAT(result.out, Contains("--help"));
  }
  const auto version = run_program({"version"});
  CHECK(version.code == 0);
  CHECK(version.out == run_program({"--version"}).out);
  CHECK(run_program({"help", "rnu"}).code == 2);
}

TEST_CASE("command line: a dumb terminal gets no escape codes", "[cli]") {
  const TemporaryFolder folder;
  const std::vector<std::string> run = {"run", small_sequence(), "--device", "reference",   "--frames",
                                        "0:1", "--force",        "-o",       folder / "out"};
  CHECK_THAT(run_on_terminal(run, 80, "TERM=xterm"), Contains("\x1b[K") && Contains("frame 1/1"));
  for (const char* environment : {"TERM=dumb", "-u TERM"})
    CHECK_THAT(run_on_terminal(run, 80, environment), !Contains("\x1b") && Contains("frame 1/1"));
}

TEST_CASE("command line: invalid use ends with code 2 and names the error", "[cli]") {
  const auto unknown = run_program({"run", "x", "--no-such-option"});
  CHECK(unknown.code == 2);
  CHECK_THAT(unknown.err, Contains("--no-such-option"));
  CHECK_THAT(run_program({"run", "x", "--ouptut", "y"}).err,
             Contains("--ouptut") && Contains("did you mean '--output'?"));
  CHECK(run_program({}).code == 2);
  const auto command = run_program({"rnu", "x"});
  CHECK(command.code == 2);
  CHECK_THAT(command.err, Contains("unknown command 'rnu'; did you mean 'run'?"));
  CHECK_THAT(run_program({"evaluate", "trajctory"}).err, Contains("'trajctory'; did you mean 'trajectory'?"));
  CHECK_THAT(run_program({"no-such-command"}).err, Contains("unknown command 'no-such-command'") && !Contains("mean"));
  CHECK(run_program({"run"}).code == 2);
  CHECK(run_program({"evaluate"}).code == 2);
  const auto letters = run_program({"edges", "x.png", "--edges.sigma", "wide"});
  CHECK(letters.code == 2);
  CHECK_THAT(letters.err, Contains("edges.sigma") && Contains("wide"));
  for (const std::string seed : {"-1", "010", "0x10", "18446744073709551616", "1.5", ""}) {
    INFO(seed);
    const auto result = run_program({"edges", "x.png", "--seed", seed});
    CHECK(result.code == 2);
    CHECK_THAT(result.err, Contains("seed"));
  }
  CHECK_THAT(run_program({"edges", "x.png", "--edges.sigma", ""}).err,
             Contains("edges.sigma") && Contains("not a number"));
  const auto range = run_program({"edges", "x.png", "--stereo.ncc_min", "1.5"});
  CHECK(range.code == 2);
  CHECK_THAT(range.err, Contains("stereo.ncc_min") && Contains("1.5") && Contains("0.01 to 1"));
  const auto format = run_program({"run", "x", "--format", "betamax"});
  CHECK(format.code == 2);
  CHECK_THAT(format.err, Contains("betamax") && Contains("kitti"));
  const auto frames = run_program({"run", "x", "--frames", "7"});
  CHECK(frames.code == 2);
  CHECK_THAT(frames.err, Contains("A:B"));
  CHECK(run_program({"run", "x", "--frames", "3:z"}).code == 2);
  CHECK(run_program({"run", "x", "--min-tracked", "150"}).code == 2);
  CHECK(run_program({"demo", "--size", "320"}).code == 2);
  CHECK(run_program({"demo", "--size", "320x200x3"}).code == 2);
  CHECK(run_program({"demo", "--scene", "kitchen"}).code == 2);
}

TEST_CASE("command line: an unknown variant is refused with a list of the known ones", "[cli]") {
  const auto stage = run_program({"demo", "--variant", "cooking=fast"});
  CHECK(stage.code == 2);
  CHECK_THAT(stage.err, Contains("cooking") && Contains("undistortion"));
  CHECK(run_program({"demo", "--variant", "undistortion"}).code == 2);
  CHECK_THAT(run_program({"variants"}).out, Contains("undistortion") && Contains("item64") && Contains("cpu"));
}

TEST_CASE("configuration file: unknown keys, bad values and missing files end with code 2 and name the key", "[cli]") {
  const TemporaryFolder folder;
  const auto with_file = [&](const std::string& text) {
    std::ofstream(folder / "config.toml") << text;
    return run_program({"edges", "x.png", "--config", folder / "config.toml"});
  };
  const auto unknown = with_file("[stereo]\nncc_minimum = 0.7\n");
  CHECK(unknown.code == 2);
  CHECK_THAT(unknown.err, Contains("stereo.ncc_minimum") && Contains("config.toml"));
  const auto top = with_file("sigma = 2\n");
  CHECK(top.code == 2);
  CHECK_THAT(top.err, Contains("\"sigma\""));
  const auto positional = with_file("IMAGE = \"other.png\"\n");
  CHECK(positional.code == 2);
  const auto text = with_file("[edges]\nsigma = \"wide\"\n");
  CHECK(text.code == 2);
  CHECK_THAT(text.err, Contains("edges.sigma") && Contains("wide"));
  const auto range = with_file("[edges]\nsigma = 1000\n");
  CHECK(range.code == 2);
  CHECK_THAT(range.err, Contains("edges.sigma") && Contains("1000"));
  const auto twice = with_file("seed = 3\n[edges]\nsigma = 2\n[stereo]\nncc_min = 0.5\n[edges]\nsigma = 3\n");
  CHECK(twice.code == 2);
  CHECK_THAT(twice.err, Contains("config.toml:6:") && Contains("'edges'"));
  const auto both_names = with_file("max-disparity = 3\n[stereo]\nmax_disparity = 2\n");
  CHECK(both_names.code == 2);
  CHECK_THAT(both_names.err, Contains("config.toml:3: stereo.max_disparity") && Contains("max-disparity"));
  const auto flag = with_file("force = 1\n");
  CHECK(flag.code == 2);
  CHECK_THAT(flag.err, Contains("config.toml:1: force: expected true or false, found 1"));
  const auto missing = run_program({"edges", "x.png", "--config", folder / "absent.toml"});
  CHECK(missing.code == 2);
  CHECK_THAT(missing.err, Contains("absent.toml"));
  CHECK(run_program({"edges", "x.png", "--config", folder.path()}).code == 2);
}

TEST_CASE("configuration file: the command line overrides the environment, which overrides the file", "[cli]") {
  // The message about the unknown device shows which setting counts.
  const TemporaryFolder folder;
  std::ofstream(folder / "config.toml") << "device = \"from-file\"\n";
  const auto device = [&](std::vector<std::string> arguments, const std::string& environment) {
    arguments.insert(arguments.begin(), {"demo", "--frames", "1", "--config", folder / "config.toml"});
    return run_program(arguments, environment).err;
  };
  CHECK_THAT(device({}, ""), Contains("from-file"));
  CHECK_THAT(device({}, "QUADEDGE_DEVICE=from-environment"), Contains("from-environment"));
  CHECK_THAT(device({"--device", "from-command-line"}, "QUADEDGE_DEVICE=from-environment"),
             Contains("from-command-line"));
}

TEST_CASE("configuration file: the command line overrides it, but invalid values in it are still errors", "[cli]") {
  const TemporaryFolder folder;
  std::ofstream(folder / "config.toml") << "[edges]\nsigma = 3\n";
  std::ofstream(folder / "wrong.toml") << "[edges]\nsigma = 1000  # far out of range\n";
  const auto edges = [&](const std::string& file, const std::string& sigma) {
    return run_program({"edges", folder / "absent.png", "--config", folder / file, "--edges.sigma", sigma});
  };
  CHECK(edges("config.toml", "2").code == 3);  // only the image is missing
  CHECK(edges("config.toml", "1000").code == 2);
  const auto wrong = edges("wrong.toml", "2");
  CHECK(wrong.code == 2);
  CHECK_THAT(wrong.err, Contains("wrong.toml:2: edges.sigma: expected 0.5 to 8, found 1000"));
}
