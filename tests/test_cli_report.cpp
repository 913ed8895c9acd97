#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "dataset_files.hpp"
#include "made_up_run.hpp"
#include "program.hpp"

using Catch::Matchers::Contains;
using dataset_files::write_text;
using namespace quadedge;
namespace fs = std::filesystem;

namespace {

/// A batch of one made-up run, which is also a single run.
std::string made_up_batch(const TemporaryFolder& folder) {
  const std::string batch = folder / "my results";
  write_batch(batch, {{"street", made_up_run(12, 0.01)}});
  return batch;
}

/// A substitute for Python that records its arguments, one per line, and ends with `code`.
std::string python_that_ends_with(int code, const TemporaryFolder& folder) {
  const std::string file = folder / "python's place";
  write_text(file, "#!/bin/sh\n[ \"$1\" = -c ] && exit 0\nprintf '%s\\n' \"$@\" >'" + (folder / "arguments") +
                       "'\nexit " + std::to_string(code) + "\n");
  fs::permissions(file, fs::perms::owner_all);
  return "QUADEDGE_PYTHON=\"" + file + "\"";
}

const std::string kNoPython = "QUADEDGE_PYTHON=/absent/python";

/// Whether the text is the single line that explains how to get a report.
bool tells_how_to_install(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n') == 1 && text.find("scripts/run.sh") != std::string::npos &&
         text.find("/absent/python") != std::string::npos && text.find("QUADEDGE_PYTHON") != std::string::npos;
}

}  // namespace

TEST_CASE("report: starts the Python module with the results and the given options", "[cli]") {
  const TemporaryFolder folder;
  const std::string batch = made_up_batch(folder), environment = python_that_ends_with(0, folder);
  const auto arguments_of = [&](const std::vector<std::string>& options) {
    std::vector<std::string> command = {"report"};
    command.insert(command.end(), options.begin(), options.end());
    run_well(command, environment);
    return read_lines(folder / "arguments");
  };
  CHECK(arguments_of({batch}) ==
        std::vector<std::string>{"-m", "quadedge.report", batch, "--output", batch + "/report.html"});
  CHECK(arguments_of({batch, "-o", folder / "$(touch no).html", "--latex", folder / "t", "--figures", folder / "f"}) ==
        std::vector<std::string>{"-m", "quadedge.report", batch, "--output", folder / "$(touch no).html", "--latex",
                                 folder / "t", "--figures", folder / "f"});
  CHECK(arguments_of({batch + "/sequences/street", "--csv", folder / "c"}) ==
        std::vector<std::string>{"-m", "quadedge.report", batch + "/sequences/street", "--output",
                                 batch + "/sequences/street/report.html", "--csv", folder / "c"});
  CHECK(arguments_of({batch, "--baseline", batch, "-o", folder / "c.html"}) ==
        std::vector<std::string>{"-m", "quadedge.report", batch, "--output", folder / "c.html", "--comparison",
                                 folder / "c.json"});
  CHECK(nlohmann::json::parse(read_text(folder / "c.json"))["sequences"][0]["systems"][0]["name"] == "baseline");
  CHECK(run_program({"report", batch}, python_that_ends_with(3, folder)).code == 3);
}

TEST_CASE("report: without the Python module one line explains how to install it, after all other output", "[cli]") {
  const TemporaryFolder folder;
  const std::string batch = made_up_batch(folder);
  const auto page = run_program({"report", batch, "--peer", "Us=" + batch}, kNoPython);
  CHECK(page.code == 2);
  CHECK(tells_how_to_install(page.err));
  CHECK(nlohmann::json::parse(read_text(batch + "/comparison.json"))["peers"][0]["name"] == "Us");
  CHECK_FALSE(fs::exists(batch + "/report.html"));
}

TEST_CASE("report: non-results, unknown peers and existing files are refused before Python starts", "[cli]") {
  const TemporaryFolder folder;
  const std::string batch = made_up_batch(folder), run = batch + "/sequences/street";
  std::ofstream(folder / "there.html") << "in the way";
  const std::string environment = python_that_ends_with(0, folder);
  const auto code_of = [&](const std::vector<std::string>& command) { return run_program(command, environment).code; };
  CHECK(code_of({"report", folder.path()}) == 3);
  CHECK(code_of({"report", batch, "-o", folder / "there.html"}) == 2);
  CHECK(code_of({"report", batch, "-o", folder / "there.html", "--force"}) == 0);
  CHECK(code_of({"report", batch, "--peer", "no folder"}) == 2);
  CHECK(code_of({"report", batch, "--peer", "QuadEdge=" + batch}) == 2);
  CHECK(code_of({"report", batch, "--peer", "a=" + batch, "--peer", "a=" + batch}) == 2);
  CHECK(code_of({"report", batch, "--peer", "a=" + (folder / "absent")}) == 3);
  CHECK(code_of({"report", run, "--baseline", batch}) == 2);
  CHECK(code_of({"report", batch, "--baseline", batch, "-o", folder / "x.json"}) == 2);
}
