#include "data/rendered_frames.hpp"
#include "testing.hpp"

using namespace quadedge;
using data::RenderedFrames;
namespace fs = std::filesystem;

namespace {

SyntheticOptions small_scene(int frames = 3) { return rendering(64, 40, 36, frames, 2); }

/// Reads all frames and compares them with the renderer's. \returns the number of frames that had to be rendered
int rendered_frames(const SyntheticOptions& options, const std::string& folder,
                    std::uintmax_t bound = RenderedFrames::kBound) {
  const auto frames = std::make_shared<RenderedFrames>(options, folder, bound);
  const auto reader = frames->open();
  const SyntheticSequence sequence(options);
  for (int i = 0; i < options.frames; ++i) {
    const auto frame = reader->next();
    REQUIRE(frame);
    CHECK(frame->number == i);
    CHECK(frame->stamp_ns == sequence.stamp_ns(i));
    CHECK(frame->left.pixels == sequence.render(i, Side::left).image.pixels);
    CHECK(frame->right.pixels == sequence.render(i, Side::right).image.pixels);
    CHECK(frame->left.max_value == sequence.rig().max_value);
  }
  CHECK_FALSE(reader->next());
  return frames->rendered();
}

std::vector<fs::path> files_below(const std::string& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::uintmax_t bytes_in(const std::string& folder) {
  std::uintmax_t bytes = 0;
  for (const auto& file : files_below(folder)) bytes += fs::file_size(file);
  return bytes;
}

}  // namespace

TEST_CASE("rendered frames: a second run reads the frames that the first rendered") {
  const TemporaryFolder folder;
  CHECK(rendered_frames(small_scene(), folder / "cache") == 3);
  CHECK(files_below(folder / "cache").size() == 6);
  CHECK(rendered_frames(small_scene(), folder / "cache") == 0);
  CHECK(rendered_frames(small_scene(2), folder / "cache") == 0);  // a shorter sequence has the same images
  CHECK(rendered_frames(small_scene(5), folder / "cache") == 2);  // a longer one lacks the rest
}

TEST_CASE("rendered frames: every option that affects pixels has separate images") {
  const TemporaryFolder folder;
  std::vector<SyntheticOptions> scenes(13, small_scene(1));
  scenes[1].scene = "cables";
  scenes[2].width = 66;
  scenes[3].height = 42;
  scenes[4].focal = 37;
  scenes[5].baseline = 0.07;
  scenes[6].noise = 3;
  scenes[7].right_gain = 1.5;
  scenes[8].seed = 8;
  scenes[9].mover = 0.2;
  scenes[10].supersampling = 3;
  scenes[11].path = "handheld";
  scenes[12].path = "loop";
  for (const auto& scene : scenes) CHECK(rendered_frames(scene, folder / "cache") == 1);
  CHECK(files_below(folder / "cache").size() == 26);
  auto threads = small_scene(1);
  threads.threads = 3;
  CHECK(rendered_frames(threads, folder / "cache") == 0);
  auto longer_loop = small_scene(2);
  longer_loop.path = "loop";
  CHECK(rendered_frames(longer_loop, folder / "cache") == 2);  // its first frame belongs to another loop
}

TEST_CASE("rendered frames: a damaged entry is rendered again and repaired") {
  const TemporaryFolder folder;
  REQUIRE(rendered_frames(small_scene(), folder / "cache") == 3);
  const auto file = files_below(folder / "cache")[2];  // one view of the second frame
  const auto size = fs::file_size(file);
  SECTION("a pixel") {
    std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
    stream.seekg(static_cast<std::streamoff>(size) / 2);
    const auto pixel = static_cast<char>(stream.get() ^ 1);
    stream.seekp(static_cast<std::streamoff>(size) / 2);
    stream.put(pixel);
  }
  SECTION("the header") { std::fstream(file, std::ios::binary | std::ios::in | std::ios::out) << "P6"; }
  SECTION("truncated") { fs::resize_file(file, size / 2); }
  SECTION("empty") { fs::resize_file(file, 0); }
  SECTION("missing") { fs::remove(file); }
  SECTION("a folder") {
    fs::remove(file);
    fs::create_directory(file);
    CHECK(rendered_frames(small_scene(), folder / "cache") == 1);
    fs::remove(file);
  }
  CHECK(rendered_frames(small_scene(), folder / "cache") == 1);
  CHECK(rendered_frames(small_scene(), folder / "cache") == 0);
}

TEST_CASE("rendered frames: if the folder cannot be created, frames are only rendered") {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "in the way";
  const auto frames = std::make_shared<RenderedFrames>(small_scene(), folder / "file/cache");
  const auto reader = frames->open();
  for (int i = 0; i < 3; ++i) CHECK(reader->next());
  CHECK(frames->rendered() == 3);
  CHECK_THAT(frames->cache_error(), Catch::Matchers::Contains(folder / "file/cache"));
  CHECK(rendered_frames(small_scene(), "") == 3);
}

TEST_CASE("rendered frames: memory and disk use are limited, and the least recently used frames go first") {
  const TemporaryFolder folder;
  const std::uintmax_t bound = 2 * 2 * 64 * 40;
  CHECK(rendered_frames(small_scene(5), folder / "cache", bound) == 5);  // in three blocks
  CHECK(bytes_in(folder / "cache") <= bound);
  CHECK(files_below(folder / "cache").size() >= 2);
  std::vector<SyntheticOptions> scenes(3, small_scene(1));
  for (std::size_t i = 0; i < scenes.size(); ++i) scenes[i].seed = 100 + i;
  fs::remove_all(folder / "cache");
  for (const auto& scene : scenes) {
    CHECK(rendered_frames(scene, folder / "cache") == 1);
    for (const auto& kept : files_below(folder / "cache"))
      fs::last_write_time(kept, fs::last_write_time(kept) - std::chrono::hours(1));
  }
  const std::uintmax_t three = bytes_in(folder / "cache") + 200;
  CHECK(rendered_frames(scenes[0], folder / "cache") == 0);  // used again: now the second is the least recently used
  CHECK(rendered_frames(small_scene(1), folder / "cache", three) == 1);
  CHECK(files_below(folder / "cache").size() == 6);
  CHECK(rendered_frames(scenes[0], folder / "cache") == 0);
  CHECK(rendered_frames(scenes[2], folder / "cache") == 0);
  CHECK(rendered_frames(scenes[1], folder / "cache") == 1);
}

TEST_CASE("rendered frames: a second reader finds the frames, and a stopped one hands out nothing") {
  const TemporaryFolder folder;
  const auto frames = std::make_shared<RenderedFrames>(small_scene(), folder / "cache");
  const auto first = frames->open()->next(), again = frames->open()->next();
  REQUIRE((first && again));
  CHECK(again->number == 0);
  CHECK(again->left.pixels == first->left.pixels);
  CHECK(frames->rendered() == 3);
  CHECK(frames->ready() == 3);
  const auto stopped = frames->open();
  stopped->stop();
  CHECK_FALSE(stopped->next());
  CHECK(frames->ready() == 0);
}
