#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "background_program.hpp"
#include "batch_folders.hpp"

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

/// The result files whose bytes do not depend on run times, by their path within the folder.
std::map<std::string, std::string> timeless_files(const std::string& output) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(output + "/sequences")) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_regular_file() || name == "frames.csv" || name == "report.json" || name == "log.txt") continue;
    files[fs::relative(entry.path(), output).string()] = read_text(entry.path().string());
  }
  return files;
}

/// A complete batch over the root with its broken member, shared by the tests that only read its files.
struct SharedBatch {
  TemporaryFolder folder;
  std::string out = folder / "out";
  ProgramResult result = run_program({"batch", batch_root(), "-o", out});
};
const SharedBatch& shared_batch() {
  static const SharedBatch batch;
  return batch;
}

/// Modification times of all files below a folder, which show what was rewritten.
std::map<std::string, fs::file_time_type> write_times(const std::string& folder) {
  std::map<std::string, fs::file_time_type> times;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) times[entry.path().string()] = entry.last_write_time();
  }
  return times;
}

nlohmann::json json_of(const std::string& file) { return nlohmann::json::parse(read_text(file)); }

}  // namespace

TEST_CASE("batch: runs all sequences, names the broken one and ends with the worst exit code", "[cli][device]") {
  const auto& batch = shared_batch();
  INFO(batch.result.err);
  CHECK(batch.result.code == 3);
  CHECK_THAT(batch.result.err, Contains("broken (failed)") && Contains("calibration.txt"));
  CHECK_THAT(batch.result.out, Contains("2 of 3 sequences done, 8 of 8 frames tracked"));
  CHECK_FALSE(fs::exists(batch.out + "/unfinished"));
  const auto summary = json_of(batch.out + "/summary.json");
  REQUIRE(summary["sequences"].size() == 3);
  CHECK(summary["sequences"][0]["name"] == "first");
  CHECK(summary["sequences"][2]["name"] == "broken");
  CHECK(summary["sequences"][2]["status"] == "failed");
  CHECK_THAT(summary["sequences"][2]["message"].get<std::string>(), Contains("calibration.txt"));
  CHECK(summary["all"]["frames_tracked"] == 8);
  for (const char* name : {"first", "second"}) {
    // A member of a batch has the files of a single run, and the summary agrees with its report.
    const std::string folder = batch.out + "/sequences/" + name;
    const auto report = json_of(folder + "/report.json");
    const auto& entry = summary["sequences"][name == std::string("first") ? 0 : 1];
    CHECK(entry["accuracy"]["origin_aligned"] == report["accuracy"]["origin_aligned"]);
    CHECK(entry["latency_ms"] == report["latency_ms"]);
    for (const char* file : {"trajectory.txt", "groundtruth.txt", "errors.csv", "pictures/thumbnail_000001.jpg",
                             "pictures/pair_000002.jpg"}) {
      CHECK(fs::file_size(folder + "/" + file) > 0);
    }
  }
  CHECK(fs::file_size(batch.out + "/config.toml") > 100);
  // A Python without the module is a note, not a failure: tables and page are missing.
  CHECK_THAT(batch.result.err, Contains("no page: no_python has no module quadedge.report"));
  CHECK(summary["input"] == batch_root());
  CHECK_THAT(summary["command"].get<std::string>(), Contains("quadedge batch"));
  const TemporaryFolder alone;
  REQUIRE(run_program({"run", batch_root() + "/a/first", "-o", alone / "out", "--quiet"}).code == 0);
  CHECK(read_text(alone / "out/trajectory.txt") == read_text(batch.out + "/sequences/first/trajectory.txt"));
}

TEST_CASE("batch: finished sequences are run again only if the input, the configuration or the user requires it",
          "[cli][device]") {
  const TemporaryFolder folder;
  fs::copy(batch_root() + "/a", folder / "data", fs::copy_options::recursive);
  const std::string out = folder / "out", first = out + "/sequences/first", second = out + "/sequences/second";
  const std::vector<std::string> batch = {"batch", folder / "data", "-o", out};
  REQUIRE(run_program(batch).code == 0);
  auto before_first = write_times(first), before_second = write_times(second);
  const auto again = run_program(batch);
  CHECK(again.code == 0);
  CHECK_THAT(again.err, Contains("2 finished already"));
  CHECK(write_times(first) == before_first);

  // A new modification time does not change the input; another camera does.
  for (const auto& entry : fs::recursive_directory_iterator(folder / "data")) {
    fs::last_write_time(entry.path(), fs::file_time_type::clock::now() + std::chrono::hours(1));
  }
  CHECK_THAT(run_program(batch).err, Contains("2 finished already"));
  std::ofstream(folder / "data/second/groundtruth.txt") << "0 0 0 0 0 0 0 1\n0.05 0.02 0 0 0 0 0 1\n";
  CHECK_THAT(run_program(batch).err, Contains("1 finished already"));
  CHECK(write_times(first) == before_first);
  CHECK(write_times(second) != before_second);

  // A damaged result counts as missing and does not stop the batch.
  for (const std::string& file : {first + "/report.json", second + "/trajectory.txt"})
    fs::resize_file(file, fs::file_size(file) - 5);
  const auto repeated = run_program(batch);
  CHECK(repeated.code == 0);
  CHECK_THAT(repeated.err, Contains("0 finished already"));
  before_first = write_times(first);
  fs::remove(second + "/frames.csv");
  CHECK_THAT(run_program(batch).err, Contains("1 finished already"));
  // Another configuration gives other results.
  auto other = batch;
  other.insert(other.end(), {"--seed", "77"});
  CHECK_THAT(run_program(other).err, Contains("0 finished already"));
  CHECK(write_times(first) != before_first);
  CHECK_THAT(read_text(first + "/config.toml"), Contains("seed = 77"));
  before_first = write_times(first);
  other.insert(other.end(), {"--force", "--jobs", "2"});
  CHECK_THAT(run_program(other).err, Contains("0 finished already") && Contains("2 in parallel"));
  CHECK(write_times(first) != before_first);
  // Results of parallel runs are not reused if times are measured.
  CHECK(json_of(out + "/summary.json")["sequences"][0]["jobs"] == 2);
  other.erase(other.end() - 3, other.end());
  other.push_back("--timing");
  CHECK_THAT(run_program(other).err, Contains("0 finished already") && Contains("1 in parallel"));
}

TEST_CASE("batch: a kill leaves no partial files, and the next start ends with the same bytes", "[cli][device]") {
  const auto& whole = shared_batch();
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  const std::vector<std::string> batch = {"batch", batch_root(), "-o", out, "--quiet"};
  const auto unfinished = [&](const std::string& name) {
    return read_text(out + "/unfinished/" + name + "/trajectory_kitti.txt").size() > 20;
  };
  for (const std::string victim : {"first", "second"}) {
    BackgroundProgram program(batch, folder / "log");
    REQUIRE(program.wait_until([&] { return unfinished(victim); }));
    const int status = program.end_by(SIGKILL);
    REQUIRE(WIFSIGNALED(status));
    // The child dies with its parent: its partial results do not grow any more.
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    const std::string rows = read_text(out + "/unfinished/" + victim + "/frames.csv");
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    CHECK(read_text(out + "/unfinished/" + victim + "/frames.csv") == rows);
    CHECK_FALSE(fs::exists(out + "/sequences/" + victim));
    CHECK_FALSE(fs::exists(out + "/summary.json"));
    for (const auto& entry : fs::directory_iterator(out + "/sequences"))
      CHECK(fs::exists(entry.path() / "member.json"));
  }
  CHECK(fs::exists(out + "/sequences/first/report.json"));  // from the second start
  const auto times = write_times(out + "/sequences/first");
  const auto last = run_program(batch);
  CHECK(last.code == 3);
  CHECK(write_times(out + "/sequences/first") == times);
  const auto files = timeless_files(out);
  CHECK(files.size() > 20);
  CHECK(files == timeless_files(whole.out));
}

TEST_CASE("batch: a signal ends its children and removes partial results, and the batch can resume", "[cli][device]") {
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  const std::vector<std::string> batch = {"batch", batch_root() + "/a", "-o", out, "--jobs", "2"};
  BackgroundProgram program(batch, folder / "log");
  REQUIRE(program.wait_until([&] { return fs::exists(out + "/unfinished/second/frames.csv"); }));
  const auto locked = run_program(batch);
  CHECK(locked.code == 2);
  CHECK_THAT(locked.err, Contains("is writing to this folder") && Contains(out));
  const int status = program.end_by(SIGINT);
  REQUIRE(WIFSIGNALED(status));
  CHECK(WTERMSIG(status) == SIGINT);
  CHECK_FALSE(fs::exists(out + "/unfinished/second"));
  CHECK_FALSE(fs::exists(out + "/sequences/second"));
  CHECK_THAT(read_text(folder / "log"), Contains("interrupted") && Contains("0 of 2 sequences finished"));
  CHECK(run_program(batch).code == 0);
}

TEST_CASE("batch: separate steps give the results of the whole", "[cli][device]") {
  const auto& whole = shared_batch();
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  const auto list = run_program({"batch", batch_root(), "--list"});
  CHECK(list.out == "first\t" + batch_root() + "/a/first\nsecond\t" + batch_root() + "/a/second\nbroken\t" +
                        batch_root() + "/broken\n");
  CHECK(run_program({"batch", batch_root(), "-o", out, "--only", "first", "--quiet"}).code == 0);
  CHECK(run_program({"batch", batch_root(), "-o", out, "--gather"}).code == 3);
  CHECK(json_of(out + "/summary.json")["sequences"][1]["status"] == "not run");
  CHECK(run_program({"batch", batch_root(), "-o", out, "--only", "second", "--quiet"}).code == 0);
  const auto broken = run_program({"batch", batch_root(), "-o", out, "--only", "broken", "--quiet"});
  CHECK(broken.code == 3);
  CHECK_THAT(broken.err, Contains("calibration.txt"));
  CHECK(run_program({"batch", batch_root(), "-o", out, "--only", "third"}).code == 2);
  CHECK(run_program({"batch", batch_root(), "-o", out, "--gather"}).code == 3);
  CHECK(timeless_files(out) == timeless_files(whole.out));
  CHECK(json_of(out + "/summary.json")["all"]["pooled"] == json_of(whole.out + "/summary.json")["all"]["pooled"]);
}

TEST_CASE("batch: missing folders in a list are recorded", "[cli]") {
  const TemporaryFolder folder;
  std::ofstream(folder / "list.txt") << "absent\n";
  const auto result = run_program({"batch", folder / "list.txt", "-o", folder / "out", "--device", "reference"});
  CHECK(result.code == 3);
  CHECK_THAT(result.err, Contains("absent (failed)"));
  CHECK(json_of(folder / "out/sequences/absent/member.json")["exit_code"] == 3);
  CHECK(run_program({"batch", folder / "no_list", "-o", folder / "out"}).code == 3);
}

TEST_CASE("batch: an unwritable or full output ends with code 3 and its path", "[cli]") {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "in the way";
  for (const std::string& path : {folder / "file/out", std::string("/proc/quadedge_out")}) {
    const auto result = run_program({"batch", batch_root(), "-o", path, "--device", "reference"});
    CHECK(result.code == 3);
    CHECK_THAT(result.err, Contains(path));
  }
  // Files are limited to 1 KiB: every further write fails, as on a full disk.
  const auto full = run_program({"batch", batch_root(), "-o", folder / "out", "--device", "reference"},
                                "sh -c 'trap \"\" XFSZ; ulimit -f 2; exec \"$0\" \"$@\"'");
  CHECK(full.code == 3);
  CHECK_THAT(full.err, Contains(folder / "out/config.toml") && Contains("large"));
  CHECK_FALSE(fs::exists(folder / "out/config.toml"));
}

TEST_CASE("batch: a missing device ends the batch at once with code 4", "[cli]") {
  const TemporaryFolder folder;
  const auto result = run_program({"batch", batch_root(), "-o", folder / "out", "--device", "abacus"});
  CHECK(result.code == 4);
  CHECK_THAT(result.err, Contains("abacus"));
  CHECK(fs::is_empty(folder / "out/sequences"));
}
