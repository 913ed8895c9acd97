#include "data/find_sequences.hpp"
#include "dataset_files.hpp"

using namespace quadedge;
using namespace dataset_files;
using Catch::Matchers::Contains;

namespace {

std::vector<std::string> names(const std::vector<data::FoundSequence>& sequences) {
  std::vector<std::string> found;
  for (const auto& sequence : sequences) found.push_back(sequence.name + " " + sequence.format);
  return found;
}

}  // namespace

TEST_CASE("find sequences: a folder of still pairs is told from one without any data") {
  const TemporaryFolder folder;
  for (const char* name : {"two_view/a/im0.png", "two_view/a/im1.png", "two_view/b/im0.png", "two_view/b/im1.png"})
    write_image(folder / name);
  CHECK_THROWS_WITH(data::find_sequences(folder.path()), Contains("2 still pairs") && Contains("quadedge.matching"));
  std::filesystem::remove_all(folder / "two_view");
  CHECK_THROWS_WITH(data::find_sequences(folder.path()), Contains("no sequence") && Contains("eth3d-stereo-pairs"));
}

TEST_CASE("find sequences: all layouts below a folder are found, except still pairs") {
  const TemporaryFolder folder;
  write_kitti(folder / "data/kitti");
  write_euroc(folder / "data/flights/V1 01");
  write_eth3d_slam(folder / "data/slam/training/cables_1");
  write_image(folder / "data/two_view_training/forest/im0.png");
  write_image(folder / "data/two_view_training/forest/im1.png");
  write_image(folder / "data/.hidden/rgb2/1.png");
  CHECK(names(data::find_sequences(folder / "data")) ==
        std::vector<std::string>{"V1_01 euroc", "kitti_07 kitti", "cables_1 eth3d-slam"});
  // The folder itself may be a sequence, also with a trailing slash, and EuRoC's inner folder.
  CHECK(names(data::find_sequences(folder / "data/slam/training/cables_1/")) ==
        std::vector<std::string>{"cables_1 eth3d-slam"});
  CHECK(names(data::find_sequences(folder / "data/flights/V1 01/mav0")) == std::vector<std::string>{"V1_01 euroc"});
}

TEST_CASE("find sequences: equal names are extended until they differ") {
  const TemporaryFolder folder;
  for (const char* place : {"monday/room", "tuesday/room", "tuesday/hall"}) write_eth3d_slam(folder / place, 1);
  CHECK(names(data::find_sequences(folder.path())) ==
        std::vector<std::string>{"monday_room eth3d-slam", "hall eth3d-slam", "tuesday_room eth3d-slam"});
}

TEST_CASE("find sequences: links are followed, cycles end, nothing is found twice") {
  const TemporaryFolder folder;
  write_eth3d_slam(folder / "elsewhere/room", 1);
  std::filesystem::create_directories(folder / "root/deep");
  std::filesystem::create_directory_symlink(folder / "elsewhere/room", folder / "root/link");
  std::filesystem::create_directory_symlink(folder / "elsewhere", folder / "root/other_link");
  std::filesystem::create_directory_symlink(folder / "root", folder / "root/deep/circle");
  const auto found = data::find_sequences(folder / "root");
  REQUIRE(found.size() == 1);
  CHECK(found[0].path == folder / "root/link");
}

TEST_CASE("find sequences: a list keeps its order and its invalid lines") {
  const TemporaryFolder folder;
  write_eth3d_slam(folder / "b", 1);
  write_eth3d_slam(folder / "a", 1);
  write_kitti(folder / "kitti", 1);
  std::filesystem::create_directories(folder / "empty");
  write_text(folder / "list.txt", "# comment\nb\n\nabsent/folder  \nempty\n" + (folder / "kitti") + "\na\nb\n");
  const auto found = data::find_sequences(folder / "list.txt");
  CHECK(names(found) ==
        std::vector<std::string>{"b eth3d-slam", "folder ", "empty ", "kitti_07 kitti", "a eth3d-slam"});
  CHECK(found[1].path == folder / "absent/folder");
}

TEST_CASE("find sequences: a folder or list without sequences is an error that names it") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "empty");
  write_text(folder / "list.txt", "# nothing\n");
  for (const char* place : {"absent", "empty", "list.txt"}) {
    CHECK_THROWS_WITH(data::find_sequences(folder / place), Contains(folder / place));
    CHECK_THROWS_AS(data::find_sequences(folder / place), DataError);
  }
}
