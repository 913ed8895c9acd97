/// \file test_generated_pages.cpp  Shell completion.
#include "program.hpp"

namespace {

/// A shell command's output on both streams. A missing tool is a failure.
std::string shell(const std::string& command) {
  const TemporaryFolder folder;
  const int status = std::system(("(" + command + ") >'" + (folder / "out") + "' 2>&1").c_str());
  const std::string out = read_text(folder / "out");
  INFO(command << "\n" << out);
  REQUIRE((WIFEXITED(status) && WEXITSTATUS(status) == 0));
  return out;
}

/// Completions of bash for the line "quadedge WORDS..." while the last word is being typed.
std::string completions(const std::string& script, const std::vector<std::string>& words) {
  std::string line = "COMP_WORDS=('" QUADEDGE_PROGRAM "'";
  for (const auto& word : words) line += " '" + word + "'";
  line += "); COMP_CWORD=" + std::to_string(words.size());
  return shell("bash -uc 'source \"" + script + "\"; " + "eval \"$0\"; _quadedge; echo \"${COMPREPLY[@]}\"' \"" + line +
               "\"");
}

}  // namespace

TEST_CASE("bash completion: completes commands, options, their values and constants", "[cli]") {
  const std::string script = QUADEDGE_KERNELS "/../cmake/quadedge.bash";
  CHECK(completions(script, {"ru"}) == "run\n");
  CHECK(completions(script, {"--v"}) == "--version\n");
  CHECK(completions(script, {"evaluate", "tr"}) == "trajectory\n");
  CHECK(completions(script, {"evaluate", "trajectory", "--from"}) == "--from-frame\n");
  CHECK(completions(script, {"run", "x", "--form"}) == "--format\n");
  CHECK(completions(script, {"run", "x", "--format", "eur"}) == "euroc\n");
  CHECK(completions(script, {"run", "--stereo.ncc_n"}) == "--stereo.ncc_nearly_best\n");
  CHECK(completions(script, {"demo", "--odometry.key_rig", "t"}) == "true\n");
  CHECK(completions(script, {"run", "x", "--output", "res"}) == "\n");  // a file, which bash completes itself
}
