#include "dataset_files.hpp"
#include "program.hpp"

namespace fs = std::filesystem;

namespace {

/// The folder of a batch, as far as the program looks at it.
std::string made_up_batch(const TemporaryFolder& folder) {
  write_text(folder / "my results/summary.json", "{}");
  write_text(folder / "my results/sequences/street/report.json", "{}");
  return folder / "my results";
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
  const auto arguments_of = [&](const Words& options) {
    run_well(Words{"report"} + options, environment);
    return read_lines(folder / "arguments");
  };
  CHECK(arguments_of({batch}) == Words{"-m", "quadedge.report", batch});
  CHECK(arguments_of({batch + "/sequences/street", "-o", folder / "$(touch no).html", "--csv", folder / "c"}) ==
        Words{"-m", "quadedge.report", batch + "/sequences/street", "--output", folder / "$(touch no).html", "--csv",
              folder / "c"});
  CHECK(run_program({"report", batch}, python_that_ends_with(3, folder)).code == 3);
}

TEST_CASE("report: without the Python module one line explains how to install it, after all other output", "[cli]") {
  const TemporaryFolder folder;
  const std::string batch = made_up_batch(folder);
  const auto page = run_program({"report", batch}, kNoPython);
  CHECK(page.code == 2);
  CHECK(tells_how_to_install(page.err));
  CHECK_FALSE(fs::exists(batch + "/report.html"));
}

TEST_CASE("report: non-results and existing files are refused before Python starts", "[cli]") {
  const TemporaryFolder folder;
  const std::string batch = made_up_batch(folder);
  std::ofstream(folder / "there.html") << "in the way";
  const std::string environment = python_that_ends_with(0, folder);
  const auto code_of = [&](const Words& command) { return run_program(command, environment).code; };
  CHECK(code_of({"report", folder.path()}) == 3);
  CHECK(code_of({"report", batch, "-o", folder / "there.html"}) == 2);
  CHECK(code_of({"report", batch, "-o", folder / "there.html", "--force"}) == 0);
}
