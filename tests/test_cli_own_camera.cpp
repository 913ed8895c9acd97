#include <csignal>

#include "background_program.hpp"
#include "own_camera.hpp"

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

/// The small sequence as a stream of images, as a side-by-side video, and its calibration.
struct OwnCamera {
  TemporaryFolder folder;
  std::string calibration = own_camera::write_calibration_of_small(folder / "rig.yaml");
  std::string stream = folder / "pairs.pgm", video = folder / "both.mkv";
  OwnCamera() {
    write_text(stream, own_camera::pgm_stream_of_small());
    std::string both;
    for (const auto& frame : own_camera::small_dataset().frames) {
      both += own_camera::pgm(
          own_camera::joined(quadedge::read_grey_image(frame.left), quadedge::read_grey_image(frame.right)));
    }
    write_text(folder / "both.pgm", both);
    own_camera::encode(folder / "both.pgm", "-c:v ffv1 -pix_fmt gray -g 1", video);
  }
};

const OwnCamera& camera() {
  static const OwnCamera all;
  return all;
}

/// Arguments of a run that reads from the video.
Words video_run(const std::string& video, const std::string& out) {
  return {"run", "--video", video, "--split", "left-right", "--calibration", camera().calibration, "-o", out};
}

/// A command prefix that pipes a file into the program.
std::string through_a_pipe(const std::string& file) { return "sh -c 'cat \"" + file + "\" | \"$0\" \"$@\"'"; }

/// Whether a process was started with the word `argument`.
bool runs_with(const std::string& argument) {
  for (const auto& process : fs::directory_iterator("/proc")) {
    std::ifstream file(process.path() / "cmdline");
    for (std::string word; std::getline(file, word, '\0');)
      if (word == argument) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("run: folders, a video and a pipe of the same images give the same trajectory", "[cli][device]") {
  const TemporaryFolder folder;
  const std::string rgb = small_sequence() + "/rgb", rgb2 = small_sequence() + "/rgb2";
  run_well({"run", "--left", rgb, "--right", rgb2, "--fps", "20", "--calibration", camera().calibration, "-o",
            folder / "folders"});
  const std::string expected = read_text(folder / "folders/trajectory.txt");
  CHECK(read_lines(folder / "folders/trajectory.txt").size() == 5);
  run_well(video_run(camera().video, folder / "video"));
  CHECK(read_text(folder / "video/trajectory.txt") == expected);
  run_well({"run", "-", "--fps", "20", "--calibration", camera().calibration, "-o", folder / "pipe"},
           through_a_pipe(camera().stream));
  CHECK(read_text(folder / "pipe/trajectory.txt") == expected);
  CHECK_THAT(read_text(folder / "pipe/report.json"), Contains("\"dropped\": 0") && Contains("\"frames\": 4"));
}

TEST_CASE("run: nanosecond names stay the stamps with --fps, which only has to agree with them", "[cli][device]") {
  const TemporaryFolder folder;
  for (const char* side : {"left", "right"}) fs::create_directory(folder / side);
  constexpr std::int64_t kFirst = 1403715273262142976;
  Words stamps;
  const auto& frames = own_camera::small_dataset().frames;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::string name = std::to_string(kFirst + 50'000'000 * static_cast<std::int64_t>(i));
    fs::copy(frames[i].left, folder / ("left/" + name + ".png"));
    fs::copy(frames[i].right, folder / ("right/" + name + ".png"));
    stamps.push_back(name.substr(0, 10) + "." + name.substr(10));
  }
  const auto run = [&](const std::string& fps, const std::string& out) {
    return run_well({"run", "--left", folder / "left", "--right", folder / "right", "--fps", fps, "--quiet",
                     "--calibration", camera().calibration, "-o", folder / out});
  };
  CHECK_THAT(run("20", "agreeing").err, !Contains("warning"));
  const auto rows = read_lines(folder / "agreeing/trajectory.txt");
  REQUIRE(rows.size() == 1 + stamps.size());
  for (std::size_t i = 0; i < stamps.size(); ++i) CHECK(rows[i + 1].rfind(stamps[i] + " ", 0) == 0);

  CHECK_THAT(run("30", "contradicting").err,
             Contains("warning: --fps 30 contradicts the timestamps, whose rate is 20 Hz"));
  CHECK(read_text(folder / "contradicting/trajectory.txt") == read_text(folder / "agreeing/trajectory.txt"));
  CHECK_THAT(read_text(folder / "contradicting/report.json"), Contains("--fps 30 contradicts"));
}

TEST_CASE("run: a pipe is read whole; with --live, pairs that come too fast are dropped and counted", "[cli][device]") {
  const TemporaryFolder folder;
  const std::string all = own_camera::pgm_stream_of_small();
  write_text(folder / "many.pgm", all + all + all + all + all);
  Words run = {"run",           "-", "--fps", "20", "--min-tracked", "0", "--calibration", camera().calibration, "-o",
               folder / "whole"};
  CHECK_THAT(run_well(run, through_a_pipe(folder / "many.pgm")).out, !Contains("dropped"));
  CHECK(read_lines(folder / "whole/frames.csv").size() == 21);
  CHECK_THAT(read_text(folder / "whole/report.json"), Contains("\"dropped\": 0"));
  // All pairs arrive while kernels are built or read: four wait.
  run.back() = folder / "live";
  run.emplace_back("--live");
  const std::string summary = run_well(run, through_a_pipe(folder / "many.pgm")).out;
  const auto frames = read_lines(folder / "live/frames.csv").size() - 1;
  CHECK((frames >= 4 && frames < 20));
  const std::string dropped = std::to_string(20 - frames);
  CHECK_THAT(read_text(folder / "live/report.json"), Contains("\"dropped\": " + dropped));
  CHECK_THAT(summary, Contains("dropped    " + dropped + " pairs"));
}

TEST_CASE("run: a video that ends early ends with code 3, and its frames and map are kept", "[cli][device]") {
  const TemporaryFolder folder;
  fs::copy(camera().video, folder / "cut.mkv");
  fs::resize_file(folder / "cut.mkv", fs::file_size(folder / "cut.mkv") * 3 / 4);
  check_error(
      video_run(folder / "cut.mkv", folder / "out") + Words{"--points", folder / "map.ply", "--points-min-views", "1"},
      3, {"cut.mkv", "finished frame"});
  CHECK_THAT(read_text(folder / "out/report.json"), Contains("ended_early") && Contains("cut.mkv"));
  CHECK(read_lines(folder / "out/trajectory_kitti.txt").size() >= 2);
  CHECK_THAT(read_text(folder / "map.ply").substr(0, 300), Contains("element vertex") && !Contains("vertex 0"));
}

TEST_CASE("run: ffmpeg ends with a run, whichever signal ends it", "[cli][device]") {
  const TemporaryFolder folder;
  const std::string pictures = read_text(camera().folder / "both.pgm");
  {
    std::ofstream many(folder / "many.pgm", std::ios::binary);
    for (int i = 0; i < 200; ++i) many << pictures;
  }
  own_camera::encode(folder / "many.pgm", "-c:v ffv1 -pix_fmt gray -g 1", folder / "many.mkv");
  for (const int signal : {SIGINT, SIGKILL}) {
    const std::string out = folder / ("out" + std::to_string(signal));
    BackgroundProgram program(video_run(folder / "many.mkv", out), folder / "log");
    CHECK(program.wait_until([&] { return read_lines(out + "/frames.csv").size() >= 3; }));
    CHECK(runs_with("file:" + (folder / "many.mkv")));
    CHECK(WTERMSIG(program.end_by(signal)) == signal);
    for (int i = 0; i < 100 && runs_with("file:" + (folder / "many.mkv")); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    CHECK_FALSE(runs_with("file:" + (folder / "many.mkv")));
    if (signal == SIGINT) CHECK_THAT(read_text(folder / "log"), Contains("interrupted after"));
  }
}

TEST_CASE("run: a signal ends a run that waits for a pipe, and its frames and map are kept", "[cli][device]") {
  const TemporaryFolder folder;
  REQUIRE(mkfifo((folder / "fifo").c_str(), 0600) == 0);
  const int held = open((folder / "fifo").c_str(), O_RDWR);  // so that readers never see its end
  BackgroundProgram program({"run", "-", "--fps", "20", "--calibration", camera().calibration, "-o", folder / "out",
                             "--points", folder / "map.ply", "--points-min-views", "1"},
                            folder / "log", "sh -c 'exec \"$0\" \"$@\" <" + (folder / "fifo") + "'");
  const std::string bytes = own_camera::pgm_stream_of_small();
  std::thread writer([&] {
    for (std::size_t at = 0; at < bytes.size();) {
      const auto count = write(held, bytes.data() + at, bytes.size() - at);
      if (count <= 0) break;
      at += static_cast<std::size_t>(count);
    }
  });
  CHECK(program.wait_until([&] { return read_lines(folder / "out/frames.csv").size() == 5; }));
  writer.join();
  const int status = program.end_by(SIGINT);
  CHECK((WIFSIGNALED(status) && WTERMSIG(status) == SIGINT));
  CHECK_THAT(read_text(folder / "log"), Contains("tracked    4 of 4 frames") && Contains("path       ") &&
                                            Contains("interrupted after 4 frames; results of these frames are in"));
  CHECK_THAT(read_text(folder / "out/report.json"),
             Contains("\"ended_early\": \"interrupted after 4 frames\"") && Contains("\"frames_tracked\": 4"));
  CHECK(read_lines(folder / "out/trajectory.txt").size() == 5);
  CHECK_THAT(read_text(folder / "map.ply").substr(0, 300), Contains("element vertex") && !Contains("vertex 0"));
  close(held);
}

TEST_CASE("run: images of a pipe take the timestamps of --times; the report has name and options", "[cli][device]") {
  const TemporaryFolder folder;
  const Words times = {"7.000000001", "7.050000000", "7.120000000", "7.150000000"};
  std::string rows;
  for (const auto& time : times) rows += time + "\n";
  write_text(folder / "times.txt", rows);
  const auto run = [&](const std::string& file, const std::string& out) -> Words {
    return {"run", "-",         "--name", "yard", "--times", folder / file, "--calibration", camera().calibration,
            "-o",  folder / out};
  };
  run_well(run("times.txt", "out"), through_a_pipe(camera().stream));
  const auto poses = read_lines(folder / "out/trajectory.txt");
  REQUIRE(poses.size() == 1 + times.size());
  for (std::size_t i = 0; i < times.size(); ++i) CHECK(poses[i + 1].rfind(times[i] + " ", 0) == 0);
  const std::string report = read_text(folder / "out/report.json");
  CHECK_THAT(report, Contains("\"name\": \"yard\"") && Contains("\"calibration\": \"" + camera().calibration + "\"") &&
                         Contains("\"times\": \"" + (folder / "times.txt") + "\""));
  write_text(folder / "few.txt", "1\n2\n");
  check_error(run("few.txt", "few"), 3, {"few.txt: found 2 times, expected one for every pair"},
              through_a_pipe(camera().stream));
}

TEST_CASE("check and bench read own cameras", "[cli][device]") {
  const auto with_source = [&](const Words& arguments) {
    return arguments + Words{"--video", camera().video, "--split", "left-right", "--calibration", camera().calibration};
  };
  CHECK_THAT(run_well(with_source({"check"})).out, Contains("format: video") && Contains("frames: 4") &&
                                                       Contains("frame 0: epipolar residual") &&
                                                       Contains("frame 3: epipolar residual"));
  const TemporaryFolder folder;
  run_well(with_source({"bench", "--frames", "1", "--warm-up", "1", "--json", folder / "bench.json", "--quiet"}));
  CHECK_THAT(read_text(folder / "bench.json"), Contains(camera().video));
  check_error(with_source({"run", small_sequence()}), 2);
  check_error({"run", small_sequence(), "--fps", "3"}, 2);
  const auto frame = own_camera::small_dataset().frames[2];
  check_error({"match", frame.left, frame.right, "--fov", "90"}, 2, {"need --calibration"});
}
