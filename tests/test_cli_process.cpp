/// \file test_cli_process.cpp  The program as a process: closed streams, limits, permissions, and two at once.
#include "background_program.hpp"

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

/// A command prefix that lets a shell start the program with other streams or limits.
std::string through_shell(const std::string& before, const std::string& redirections) {
  return "sh -c '" + before + " exec \"$0\" \"$@\" " + redirections + "'";
}

/// A command prefix that drops root's permission to read everything; empty if there is nothing to drop.
std::string without_rights() {
  return geteuid() == 0 ? "setpriv --reuid 65534 --regid 65534 --clear-groups" : std::string();
}

}  // namespace

TEST_CASE("process: output to closed streams does not end up in a file", "[cli][device]") {
  const TemporaryFolder folder;
  run_well({"run", small_sequence(), "-o", folder / "open"});
  const std::string trajectory = read_text(folder / "open/trajectory.txt");
  int number = 0;
  for (const auto& [redirections, code] : {std::pair<const char*, int>{"2>&-", 0},
                                           {">&-", 3},  // the results cannot be printed
                                           {">&- 2>&-", 3},
                                           {"<&- >&- 2>&-", 3},
                                           {"<&-", 0}}) {
    INFO(redirections);
    const std::string out = folder / std::to_string(++number);
    const auto result = run_program({"run", small_sequence(), "-o", out}, through_shell("", redirections));
    CHECK(result.code == code);
    CHECK(read_text(out + "/trajectory.txt") == trajectory);
    for (const char* name : {"trajectory_kitti.txt", "frames.csv", "config.toml", "report.json"}) {
      CHECK_THAT(read_text(out + "/" + name), !Contains("frame 4/4") && !Contains("latency    median"));
    }
  }
}

TEST_CASE("process: two runs never write into the same folder", "[cli][device]") {
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  const Words run = {"run", small_sequence(), "-o", out};
  BackgroundProgram first(run, folder / "log");
  REQUIRE(first.wait_until([&] { return fs::exists(out + "/frames.csv"); }));
  kill(first.process(), SIGSTOP);
  for (const Words& more : {Words(), Words{"--force"}}) check_error(run + more, 2, {out, "is writing to this folder"});
  kill(first.process(), SIGCONT);
  REQUIRE_FALSE(first.wait_until([] { return false; }));
  CHECK(read_lines(out + "/trajectory.txt").size() == 5);
  CHECK(fs::exists(out + "/report.json"));
  CHECK_FALSE(fs::exists(out + "/.lock"));
}

TEST_CASE("process: an unwritable output file is refused at the start", "[cli]") {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "in the way";
  fs::create_directory(folder / "results");
  const std::string image = (*fs::directory_iterator(small_sequence() + "/rgb")).path().string();
  const std::vector<Words> commands = {
      {"run", small_sequence(), "--device", "reference", "-o", folder / "out", "--force", "--points"},
      {"bench", "--frames", "1", "--size", "160x100", "--json"},
      {"compare", "--size", "160x100", "--json"},
      {"edges", image, "--csv"}};
  for (const auto& command : commands) {
    for (const std::string& file : {folder / "absent/t.json", folder / "file/t.json", folder / "results"}) {
      check_error(command + Words{file}, 3, {file, "expected a writable location"});
      CHECK_FALSE(fs::exists(folder / "out/trajectory.txt"));
    }
  }
}

TEST_CASE("process: unreadable folders are recorded with code 3, and the others are processed", "[cli]") {
  const TemporaryFolder folder;
  fs::permissions(folder.path(), fs::perms(0755));
  const std::string tree = folder / "tree";
  fs::create_directories(tree + "/locked/inside");
  fs::create_symlink("itself", tree + "/itself");
  for (const char* name : {"one", "two"}) fs::copy(small_sequence(), tree + "/" + name, fs::copy_options::recursive);
  fs::permissions(tree + "/locked", fs::perms::none);
  const auto check =
      check_error({"check", tree}, 3, {"tree/locked: found", "Permission denied", "Too many levels"}, without_rights());
  CHECK_THAT(check.out, Contains("ok       one") && Contains("ok       two") && Contains("DAMAGED  locked") &&
                            Contains("DAMAGED  itself") && Contains("4 found, 2 of them damaged"));
  CHECK_THAT(run_well({"batch", tree, "--list"}, without_rights()).out,
             Contains("itself\t") && Contains("locked\t") && Contains("one\t") && Contains("two\t"));
  fs::permissions(tree + "/locked", fs::perms::owner_all);
}

TEST_CASE("process: an impossible path is a user error, not an internal error", "[cli]") {
  const TemporaryFolder folder;
  fs::create_symlink("itself", folder / "itself");
  for (const std::string& path : {folder / "itself", std::string(300, 'y')}) {
    for (const std::string command : {"run", "check", "batch", "report", "edges"})
      CHECK_THAT(check_error({command, path}, 3, {path}).err, !Contains("internal"));
  }
}
