#include <catch2/catch.hpp>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "data/content_hash.hpp"
#include "dataset_files.hpp"
#include "quadedge/error.hpp"
#include "temporary_folder.hpp"

using namespace quadedge;
using namespace dataset_files;
namespace fs = std::filesystem;

namespace {

std::string hash_of(const std::string& folder) { return data::dataset_hash(open_dataset(folder)); }

}  // namespace

TEST_CASE("content hash: the boundaries between values count", "[data]") {
  data::ContentHash one, two, three;
  one.add("ab"), one.add("c");
  two.add("a"), two.add("bc");
  three.add("ab"), three.add("c");
  CHECK(one.hex() != two.hex());
  CHECK(one.hex() == three.hex());
  CHECK(one.hex().size() == 32);
}

TEST_CASE("content hash: a recording's path and modification time do not count", "[data]") {
  const TemporaryFolder folder;
  write_eth3d_slam(folder / "one/room");
  const std::string before = hash_of(folder / "one/room");
  fs::copy(folder / "one", folder / "two", fs::copy_options::recursive);
  for (const auto& entry : fs::recursive_directory_iterator(folder / "two")) {
    fs::last_write_time(entry.path(), fs::file_time_type::clock::now() + std::chrono::hours(1));
  }
  write_text(folder / "two/room/notes.txt", "not read by a run");
  CHECK(hash_of(folder / "two/room") == before);
}

TEST_CASE("content hash: every part of a recording that a run reads counts", "[data]") {
  const std::vector<std::pair<std::string, std::function<void(const std::string&)>>> changes = {
      {"camera", [](const std::string& room) { write_text(room + "/calibration2.txt", "42 43 14 12.5\n"); }},
      {"extrinsics",
       [](const std::string& room) {
         write_text(room + "/extrinsics_1_2.txt", "1 0 0 -0.08\n0 1 0 0\n0 0 1 0.001\n");
       }},
      {"truth", [](const std::string& room) { write_text(room + "/groundtruth.txt", "12.025000001 1 0 0 0 0 0 1\n"); }},
      {"one pixel of one image",
       [](const std::string& room) {
         cv::Mat image = cv::imread(room + "/rgb2/12.225000001.png", cv::IMREAD_UNCHANGED);
         image.ptr(20)[50] ^= 1;
         cv::imwrite(room + "/rgb2/12.225000001.png", image);
       }},
      {"images exchanged",
       [](const std::string& room) {
         fs::rename(room + "/rgb/12.025000001.png", room + "/rgb/spare.png");
         fs::copy(room + "/rgb2/12.125000001.png", room + "/rgb/12.025000001.png");
         fs::remove(room + "/rgb/spare.png");
       }},
  };
  const TemporaryFolder folder;
  write_eth3d_slam(folder / "room");
  const std::string before = hash_of(folder / "room");
  for (const auto& [what, change] : changes) {
    INFO(what);
    fs::remove_all(folder / "changed");
    fs::create_directories(folder / "changed");
    fs::copy(folder / "room", folder / "changed/room", fs::copy_options::recursive);
    change(folder / "changed/room");
    CHECK(hash_of(folder / "changed/room") != before);
  }
}

TEST_CASE("content hash: a missing image is an error that names it", "[data]") {
  const TemporaryFolder folder;
  write_eth3d_slam(folder / "room");
  const Dataset dataset = open_dataset(folder / "room");
  fs::remove(dataset.frames[2].right);
  CHECK_THROWS_WITH(data::dataset_hash(dataset), Catch::Matchers::Contains(dataset.frames[2].right));
  CHECK_THROWS_AS(data::dataset_hash(dataset), DataError);
}
