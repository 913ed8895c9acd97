#include "data/find_sequences.hpp"
#include "own_camera.hpp"

using Catch::Matchers::Contains;
using namespace quadedge;
namespace fs = std::filesystem;

namespace {

/// The small sequence as two folders with file names that need natural sorting, and as videos.
class OwnRecording {
 public:
  OwnRecording() {
    own_camera::write_calibration_of_small(file("rig.yaml"));
    std::string both;
    std::string views[2];
    const auto& frames = own_camera::small_dataset().frames;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const std::string name = std::to_string(9 + i) + ".png";
      for (const char* side : {"left", "right"}) fs::create_directories(file(side));
      fs::copy(frames[i].left, file("left/" + name));
      fs::copy(frames[i].right, file("right/" + name));
      const Image left = read_grey_image(frames[i].left), right = read_grey_image(frames[i].right);
      both += own_camera::pgm(own_camera::joined(left, right));
      views[0] += own_camera::pgm(left);
      views[1] += own_camera::pgm(right);
    }
    encode(both, "both.mkv");
    encode(views[0], "left.mkv");
    encode(views[1], "right.mkv");
  }
  std::string file(const std::string& name) const { return folder_ / name; }
  StereoSource folders() const {
    StereoSource source;
    source.left = file("left");
    source.right = file("right");
    source.calibration = file("rig.yaml");
    source.fps = 20;
    return source;
  }
  StereoSource one_video() const {
    StereoSource source;
    source.video = file("both.mkv");
    source.split = "left-right";
    source.calibration = file("rig.yaml");
    return source;
  }
  StereoSource two_videos() const {
    StereoSource source = folders();
    source.left = file("left.mkv");
    source.right = file("right.mkv");
    source.fps = 0;
    return source;
  }

 private:
  void encode(const std::string& pictures, const std::string& name) const {
    write_text(file("pictures.pgm"), pictures);
    own_camera::encode(file("pictures.pgm"), "-c:v ffv1 -pix_fmt gray", file(name));
  }
  TemporaryFolder folder_;
};

const OwnRecording& recording() {
  static const OwnRecording all;
  return all;
}

std::string complaint(const StereoSource& source) {
  return message_of([&] {
    FramePrefetcher frames(open_stereo_source(source));
    while (frames.next()) {
    }
  });
}

}  // namespace

TEST_CASE("own camera: folders, one video and two videos give the same pairs") {
  for (const auto& source : {recording().folders(), recording().one_video(), recording().two_videos()}) {
    const Dataset dataset = open_stereo_source(source);
    INFO(dataset.format);
    CHECK(dataset.frames.size() == 4);
    CHECK(dataset.rig.left.fx == own_camera::small_dataset().rig.left.fx);
    CHECK(dataset.truth.empty());
    FramePrefetcher frames(dataset), again(dataset);
    for (int i = 0; i < 4; ++i) {
      const auto& files = own_camera::small_dataset().frames[static_cast<std::size_t>(i)];
      const auto frame = frames.next();
      REQUIRE(frame);
      CHECK(frame->number == i);
      CHECK(frame->stamp_ns == i * 50'000'000);
      CHECK(frame->left.pixels == read_grey_image(files.left).pixels);
      CHECK(frame->right.pixels == read_grey_image(files.right).pixels);
      CHECK(again.next()->left.pixels == frame->left.pixels);  // it can be read again
    }
    CHECK_FALSE(frames.next());
  }
}

TEST_CASE("own camera: a range of pairs, and timestamps from a file") {
  write_text(recording().file("stamps.txt"), "1.5\n1.75\n2\n3\n");
  for (StereoSource source : {recording().folders(), recording().one_video()}) {
    source.fps = 0;
    source.times = recording().file("stamps.txt");
    source.first_frame = 1;
    source.last_frame = 3;
    const Dataset dataset = open_stereo_source(source);
    CHECK(dataset.frames.size() == 2);
    FramePrefetcher frames(dataset);
    for (int i = 0; i < 2; ++i) {
      const auto frame = frames.next();
      REQUIRE(frame);
      CHECK(frame->number == i);
      CHECK(frame->stamp_ns == 1'750'000'000 + 250'000'000 * i);
      CHECK(frame->left.pixels ==
            read_grey_image(own_camera::small_dataset().frames[static_cast<std::size_t>(i) + 1].left).pixels);
    }
    CHECK_FALSE(frames.next());
  }
}

TEST_CASE("own camera: streams of different lengths are reported") {
  const TemporaryFolder folder;
  StereoSource source = recording().folders();
  fs::copy(source.right, folder / "right");
  fs::remove(folder / "right/11.png");
  source.right = folder / "right";
  CHECK_THAT(complaint(source), Contains(folder / "right") && Contains("3 images") && Contains("the 4 of"));
  std::swap(source.left, source.right);
  CHECK_THAT(complaint(source), Contains(folder / "right") && Contains("3 images") && Contains("the 4 of"));

  StereoSource videos = recording().two_videos();
  std::string pictures;
  for (int i = 0; i < 2; ++i)
    pictures += own_camera::pgm(read_grey_image(own_camera::small_dataset().frames[static_cast<std::size_t>(i)].right));
  write_text(folder / "pictures.pgm", pictures);
  own_camera::encode(folder / "pictures.pgm", "-c:v ffv1 -pix_fmt gray", folder / "short.mkv");
  videos.right = folder / "short.mkv";
  CHECK_THAT(complaint(videos), Contains(folder / "short.mkv") && Contains("2 frames"));
  // A raw stream does not state its length.
  own_camera::encode(folder / "pictures.pgm", "-c:v mjpeg -q:v 2", folder / "short.mjpeg");
  videos.right = folder / "short.mjpeg";
  videos.fps = 20;
  CHECK_THAT(complaint(videos), Contains(folder / "short.mjpeg") && Contains("the end after 2 frames"));
  write_text(folder / "stamps.txt", "1\n2\n3\n");
  for (StereoSource timed : {recording().folders(), recording().one_video()}) {
    timed.fps = 0;
    timed.times = folder / "stamps.txt";
    CHECK_THAT(complaint(timed), Contains(folder / "stamps.txt") && Contains("3 times"));
  }
}

TEST_CASE("own camera: images of both folders are paired by time, and those alone are dropped and counted") {
  const TemporaryFolder folder;
  const auto& frames = own_camera::small_dataset().frames;
  const auto fill = [&](const char* side, const std::vector<const char*>& names) {
    fs::create_directories(folder / side);
    for (std::size_t i = 0; i < names.size(); ++i)
      fs::copy(frames[i].left, folder / (std::string(side) + "/" + names[i] + ".png"));
  };
  fill("left", {"1.00", "1.05", "1.10"});
  fill("right", {"1.0001", "1.0499", "1.1001"});
  fill("late", {"1.00", "1.10", "1.15"});
  fill("another day", {"86401.00", "86401.05", "86401.10"});
  StereoSource source = recording().folders();
  source.fps = 0;
  source.left = folder / "left";
  source.right = folder / "right";
  CHECK(open_stereo_source(source).frames[2].stamp_ns == 1'100'000'000);
  CHECK(open_stereo_source(source).warnings.empty());
  source.tolerance_ms = 0.11;  // 0.1 ms between the stamps of every pair
  CHECK(open_stereo_source(source).frames.size() == 3);
  source.tolerance_ms = 0.09;
  CHECK_THAT(complaint(source), Contains("3 images of which 0") && Contains("--times"));
  source.tolerance_ms = 0;
  source.right = folder / "late";
  const Dataset paired = open_stereo_source(source);
  REQUIRE(paired.frames.size() == 2);
  CHECK_THAT(paired.frames[1].left, Contains("left/1.10.png"));
  CHECK_THAT(paired.frames[1].right, Contains("late/1.10.png"));
  REQUIRE(paired.warnings.size() == 1);
  CHECK_THAT(paired.warnings[0], Contains("1 left and 1 right images") && Contains("dropped"));
  source.right = folder / "another day";
  CHECK_THAT(complaint(source), Contains("another day") && Contains("86401.0") && Contains("one clock"));
}

TEST_CASE("own camera: missing and contradictory options are reported") {
  const auto complaint_of = [](StereoSource source, const std::function<void(StereoSource&)>& change) {
    change(source);
    return complaint(source);
  };
  const StereoSource folders = recording().folders(), video = recording().one_video();
  CHECK_THAT(complaint_of(folders, [](auto& s) { s.fps = 0; }), Contains("9.png") && Contains("--fps"));
  CHECK_THAT(complaint_of(folders, [](auto& s) { s.right.clear(); }), Contains("--left and --right go together"));
  CHECK_THAT(complaint_of(folders, [](auto& s) { s.calibration.clear(); }), Contains("with --calibration FILE"));
  CHECK_THAT(complaint_of(folders, [&](auto& s) { s.video = video.video; }), Contains("expected one of"));
  CHECK_THAT(complaint_of(folders, [](auto& s) { s.split = "left-right"; }), Contains("--split is for"));
  CHECK_THAT(complaint_of(video, [](auto& s) { s.split.clear(); }), Contains("--split left-right"));
  CHECK_THAT(complaint_of(video, [](auto& s) { s.split = "sideways"; }), Contains("sideways"));
  CHECK_THAT(complaint_of(video, [](auto& s) { s.split = "top-bottom"; }),  // unlike the calibration
             Contains("640 x 100") && Contains("320 x 200"));
  CHECK_THAT(complaint_of(folders, [](auto& s) { s.left = "n\xc3\xb6"; }),
             Contains("n\xc3\xb6: found no such file or folder") && Contains("folder of images"));
  CHECK_THAT(complaint_of(folders, [](auto& s) { s.right = recording().file("right.mkv"); }),
             Contains("right.mkv: found a file, expected a folder"));
  CHECK_THAT(complaint_of(folders, [](auto& s) { s.tolerance_ms = -1; }), Contains("--tolerance"));
  CHECK_THAT(complaint_of(folders, [](auto& s) { s.live = true; }), Contains("--live"));
  StereoSource pipe;
  pipe.pipe = true;
  pipe.calibration = recording().file("rig.yaml");
  CHECK_THAT(complaint(pipe), Contains("--fps"));
}

TEST_CASE("own camera: check reads everything and reports errors") {
  int seen = 0;
  const auto count = [&](const Dataset&, const StereoPair&) { ++seen; };
  for (const auto& source : {recording().folders(), recording().one_video()}) {
    seen = 0;
    const DatasetCheck check = check_stereo_source(source, count);
    CHECK(check.errors.empty());
    CHECK(seen == 4);
    CHECK(std::find(check.facts.begin(), check.facts.end(), "frames: 4") != check.facts.end());
  }
  const TemporaryFolder folder;
  fs::copy(recording().file("both.mkv"), folder / "cut.mkv");
  fs::resize_file(folder / "cut.mkv", fs::file_size(folder / "cut.mkv") * 2 / 3);
  StereoSource source = recording().one_video();
  source.video = folder / "cut.mkv";
  const DatasetCheck check = check_stereo_source(source);
  REQUIRE(check.errors.size() == 1);
  CHECK_THAT(check.errors[0], Contains("cut.mkv") && Contains("the 4 announced by its header"));
}

TEST_CASE("own camera: a line of a list is parsed and converted back to arguments") {
  const std::string line =
      "--left \"my recording/left\" --right r --calibration a.yaml,b.yaml --fps 12.5 --fov 90 --mask m.png --times "
      "t.txt";
  const StereoSource source = data::parse_source_line(line, "/base", "list.txt", 3);
  CHECK(source.left == "/base/my recording/left");
  CHECK(source.right == "/base/r");
  CHECK(source.calibration == "/base/a.yaml,/base/b.yaml");
  CHECK(source.mask == "/base/m.png");
  CHECK(source.times == "/base/t.txt");
  CHECK(source.fps == 12.5);
  CHECK(source.fov == 90);
  CHECK(data::source_words(source) == std::vector<std::string>{"--left", "/base/my recording/left", "--right",
                                                               "/base/r", "--calibration", "/base/a.yaml,/base/b.yaml",
                                                               "--times", "/base/t.txt", "--mask", "/base/m.png",
                                                               "--fps", "12.5", "--fov", "90"});
  const TemporaryFolder folder;
  fs::create_directories(folder / "my recording/mav0/cam0/data");
  for (const char* images : {"my recording/mav0/cam0/data", "my recording/mav0/cam0", "my recording/mav0"}) {
    StereoSource named;
    named.left = folder / images;
    CHECK(data::source_name(named) == "my recording");
  }
  for (const char* wrong : {"--left a --speed 3", "--left", "--fps fast", "--left a b"}) {
    INFO(wrong);
    CHECK_THROWS_WITH(data::parse_source_line(wrong, "/base", "list.txt", 3), Contains("list.txt:3"));
  }
}

TEST_CASE("own camera: lists may mix them with folders, each with a unique name") {
  const TemporaryFolder folder;
  write_text(folder / "list.txt", small_sequence() + "\n--left " + recording().file("left") + " --right " +
                                      recording().file("right") + " --calibration " + recording().file("rig.yaml") +
                                      " --fps 20\n--video " + recording().file("both.mkv") +
                                      " --split left-right --calibration " + recording().file("rig.yaml") + "\n");
  const auto found = data::find_sequences(folder / "list.txt");
  REQUIRE(found.size() == 3);
  CHECK_FALSE(found[0].source);
  REQUIRE(found[1].source);
  CHECK(found[1].source->left == recording().file("left"));
  REQUIRE(found[2].source);
  CHECK(found[2].name == "both");
  CHECK(found[1].name == fs::path(recording().file("left")).parent_path().filename().string());
}
