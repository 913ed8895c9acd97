#pragma once
/// \file program.hpp  Runs the quadedge program as a user does.

#include "testing.hpp"

/// The words of a command line.
using Words = std::vector<std::string>;
inline Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Result of a run of the program.
struct ProgramResult {
  int code = -1;  ///< exit code; -1 if a signal killed it
  std::string out, err;
};

inline std::vector<std::string> read_lines(const std::string& path) {
  std::ifstream stream(path);
  std::vector<std::string> all;
  for (std::string line; std::getline(stream, line);) all.push_back(line);
  return all;
}

/// Settings in front of a shell command: the program neither reads nor changes what the user has saved (device, kernel
/// variants, rendered frames), except for the driver's cache of compiled kernels. Its own cache is QUADEDGE_TEST_CACHE,
/// or is empty at first. Reports need a Python, which tests of reports name.
inline std::string environment_of_tests() {
  static const TemporaryFolder folder;
  const char* cache = std::getenv("QUADEDGE_TEST_CACHE");
  return "env -u QUADEDGE_DEVICE QUADEDGE_PYTHON=no_python "
         "POCL_CACHE_DIR=\"${POCL_CACHE_DIR:-${XDG_CACHE_HOME:-$HOME/.cache}/pocl/kcache}\""
         " XDG_CONFIG_HOME='" +
         (folder / "configuration") + "' XDG_CACHE_HOME='" + (cache != nullptr ? cache : folder / "cache") + "'";
}

/// The program under test, or the one in QUADEDGE_TEST_PROGRAM (run_sanitizers.sh).
inline std::string program_path() {
  const char* other = std::getenv("QUADEDGE_TEST_PROGRAM");
  return other ? other : QUADEDGE_PROGRAM;
}

/// Runs `quadedge ARGUMENTS` through the shell, with `environment` in front, for example "QUADEDGE_DEVICE=gpu". Quotes
/// the arguments.
inline ProgramResult run_program(const Words& arguments, const std::string& environment = "") {
  const TemporaryFolder folder;
  std::string command =
      "cd '" + folder.path() + "' && " + environment_of_tests() + " " + environment + " '" + program_path() + "'";
  for (const auto& argument : arguments) command += " '" + argument + "'";
  command += " >'" + (folder / "out") + "' 2>'" + (folder / "err") + "' </dev/null";
  const int status = std::system(command.c_str());
  ProgramResult result;
  // The shell reports a signal as 128 + its number, a code that the program never returns.
  if (WIFEXITED(status) && WEXITSTATUS(status) < 128) result.code = WEXITSTATUS(status);
  result.out = read_text(folder / "out");
  result.err = read_text(folder / "err");
  return result;
}

/// The same where it has to succeed.
inline ProgramResult run_well(const Words& arguments, const std::string& environment = "") {
  ProgramResult result = run_program(arguments, environment);
  INFO(Catch::StringMaker<Words>::convert(arguments) << "\n" << result.err);
  REQUIRE(result.code == 0);
  return result;
}

/// The same where it has to end with `code` and an error message that has all these words.
inline ProgramResult check_error(const Words& arguments, int code, const Words& words = {},
                                 const std::string& environment = "") {
  ProgramResult result = run_program(arguments, environment);
  INFO(Catch::StringMaker<Words>::convert(arguments));
  CHECK(result.code == code);
  for (const std::string& word : words) CHECK_THAT(result.err, Catch::Contains(word));
  return result;
}

/// A rendered sequence of 320 x 200 px, created once per process.
inline const std::string& small_sequence() {
  static const TemporaryFolder folder;
  static const std::string path = [] {
    run_well({"synth", folder / "room4", "--frames", "4", "--size", "320x200", "--quiet"});
    return folder / "room4";
  }();
  return path;
}
