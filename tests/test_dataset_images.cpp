#include <opencv2/imgproc.hpp>

#include "dataset_files.hpp"

using namespace quadedge;
using namespace dataset_files;
using Catch::Matchers::Contains;

TEST_CASE("images: a PGM's header gives the maximum value") {
  const TemporaryFolder folder;
  write_text(folder / "dim.pgm", "P5 3 1 100\n" + std::string({'\0', '\x32', '\x64'}));
  const Image dim = read_grey_image(folder / "dim.pgm");
  CHECK(dim.max_value == 100);
  CHECK(dim.view().at(0, 0) == 0);
  CHECK(dim.view().at(1, 0) == Approx(127.5));
  CHECK(dim.view().at(2, 0) == Approx(255));
  write_text(folder / "twelve.pgm", "P5 2 1 4095\n" + std::string({'\x0f', '\xff', '\x08', '\x00'}));
  const Image twelve = read_grey_image(folder / "twelve.pgm");
  CHECK(twelve.max_value == 4095);
  CHECK(twelve.view().value(0, 0) == 4095);
  CHECK(twelve.view().value(1, 0) == 2048);
  CHECK(twelve.view().at(0, 0) == Approx(255));
  write_text(folder / "none.pgm", "P5 2 1 0\n" + std::string(2, '\0'));
  CHECK_THROWS_WITH(read_grey_image(folder / "none.pgm"), Contains("none.pgm"));
}

TEST_CASE("images: truncated, empty, damaged and unrelated files are refused by name") {
  const TemporaryFolder folder;
  for (const char* name : {"cut.png", "cut.jpg", "cut.pgm"}) {
    for (const double part : {0.99, 0.6, 0.2, 0.0}) {
      INFO(name << " " << part);
      write_image(folder / name, 320, 240);
      CHECK_NOTHROW(read_grey_image(folder / name));
      truncate(folder / name, part);
      CHECK_THROWS_AS(read_grey_image(folder / name), DataError);
      CHECK_THROWS_WITH(read_grey_image(folder / name), Contains(name) && Contains("expected"));
    }
  }
  write_text(folder / "text.png", "not an image at all");
  CHECK_THROWS_WITH(read_grey_image(folder / "text.png"), Contains("text.png") && Contains("\"not an i\""));
  CHECK_THROWS_WITH(read_grey_image(folder / "absent.png"), Contains("absent.png"));
  CHECK_THROWS_WITH(read_grey_image(folder.path()), Contains("a folder"));
  REQUIRE(mkfifo((folder / "pipe.png").c_str(), 0600) == 0);  // that nobody writes to
  CHECK_THROWS_WITH(read_grey_image(folder / "pipe.png"), Contains("a pipe"));
  for (const auto& [header, bytes] : {std::pair("P5\n320 200\n255\n", 64001), {"P5 320 200 255\r\n", 64000}}) {
    write_text(folder / "long.pgm", header + std::string(static_cast<std::size_t>(bytes), 'x'));
    CHECK_THROWS_WITH(read_grey_image(folder / "long.pgm"), Contains("64016 bytes") && Contains("64015"));
  }
}

TEST_CASE("images: a JPEG that libjpeg warns about is refused, an intact one is not") {
  const TemporaryFolder folder;
  const std::string file = folder / "a.jpg";
  cv::Mat picture = pattern(160, 120);
  cv::GaussianBlur(picture, picture, {9, 9}, 2);
  for (const bool progressive : {false, true}) {
    REQUIRE(cv::imwrite(file, picture, {cv::IMWRITE_JPEG_PROGRESSIVE, progressive ? 1 : 0}));
    REQUIRE(read_grey_image(file).width == 160);
    const std::string good = read_text(file);
    // Damage that leaves the container intact: inside the entropy-coded data of the first scan.
    const std::size_t begin = good.find("\xFF\xDA") + 14;
    for (const std::size_t length : {1, 16, 200}) {
      INFO((progressive ? "progressive, " : "baseline, ") << length << " bytes lost");
      write_text(file, std::string(good).erase(begin + 40, length));
      CHECK_THROWS_AS(read_grey_image(file), DataError);
      CHECK_THROWS_WITH(read_grey_image(file), Contains("a.jpg") && Contains("damaged JPEG") && Contains("expected"));
    }
    write_text(file, std::string(good).insert(good.size() - 2, 40, '\x12'));
    CHECK_THROWS_WITH(read_grey_image(file), Contains("extraneous"));
  }
}

TEST_CASE("prefetcher: frames arrive complete and in order, however far it reads ahead") {
  const TemporaryFolder folder;
  const Dataset set = open_dataset(write_kitti(folder.path(), 9));
  for (const int ahead : {0, 1, 3, 50}) {
    FramePrefetcher prefetcher(set, ahead);
    for (int i = 0; i < 9; ++i) {
      const auto frame = prefetcher.next();
      REQUIRE(frame);
      CHECK(frame->number == i);
      CHECK(frame->stamp_ns == set.frames[static_cast<std::size_t>(i)].stamp_ns);
      CHECK(frame->left.pixels == read_grey_image(set.frames[static_cast<std::size_t>(i)].left).pixels);
      CHECK(frame->right.width == 32);
    }
    CHECK_FALSE(prefetcher.next());
    CHECK_FALSE(prefetcher.next());
  }
}

TEST_CASE("prefetcher: a bad frame is reported at its position and ends the sequence") {
  const TemporaryFolder folder;
  const std::string kitti = write_kitti(folder.path());
  const Dataset set = open_dataset(kitti);
  SECTION("truncated") {
    truncate(kitti + "/image_1/000002.png", 0.7);
    FramePrefetcher prefetcher(set);
    CHECK(prefetcher.next()->number == 0);
    CHECK(prefetcher.next()->number == 1);
    CHECK_THROWS_WITH(prefetcher.next(), Contains("image_1/000002.png") && Contains("the file ends early"));
    CHECK_FALSE(prefetcher.next());
  }
  SECTION("differs in size from its neighbours") {
    write_image(kitti + "/image_0/000001.png", 31, 24);
    FramePrefetcher prefetcher(set);
    CHECK(prefetcher.next()->number == 0);
    CHECK_THROWS_WITH(prefetcher.next(), Contains("image_0/000001.png") && Contains("31 x 24") && Contains("32 x 24"));
  }
}

TEST_CASE("prefetcher: it can be destroyed at any time") {
  const TemporaryFolder folder;
  const Dataset set = open_dataset(write_kitti(folder.path(), 9));
  for (int taken = 0; taken <= 9; ++taken) {
    FramePrefetcher prefetcher(set, 2);
    for (int i = 0; i < taken; ++i) REQUIRE(prefetcher.next());
  }
  for (int i = 0; i < 50; ++i) const FramePrefetcher unused(set, 1);
  SUCCEED("every destructor returned");
}
