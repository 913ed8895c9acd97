#include "data/image_list.hpp"
#include "data/text.hpp"
#include "dataset_files.hpp"

using Catch::Matchers::Contains;
using namespace quadedge;
using data::comes_before;
using data::file_list;
using data::list_images;
using data::number_jump;
using data::pair_stamps;
using data::read_times;
using data::StampPairs;

TEST_CASE("image list: digits in names count as numbers") {
  CHECK(comes_before("img9.png", "img10.png"));
  CHECK_FALSE(comes_before("img10.png", "img9.png"));
  CHECK(comes_before("a2b3", "a2b20"));
  CHECK(comes_before("a", "a1"));
  CHECK(comes_before("a1x", "b0"));
  CHECK(comes_before("img01", "img1"));  // equal numbers: the text decides, so that the order is unique
  CHECK_FALSE(comes_before("img1", "img01"));
  CHECK_FALSE(comes_before("same", "same"));
  CHECK(comes_before("1403636579763555584", "1403636579813555456"));
}

TEST_CASE("image list: names that can be times give the timestamps") {
  const TemporaryFolder folder;
  const auto stamps = [&](const std::string& name, const std::vector<std::string>& files) {
    for (const auto& file : files) dataset_files::write_image(folder / (name + "/images/" + file));
    return list_images(folder / (name + "/images")).stamps_ns;
  };
  using Stamps = std::vector<std::int64_t>;
  CHECK(stamps("seconds", {"1.5.png", "10.25.png"}) == Stamps{1'500'000'000, 10'250'000'000});
  CHECK(stamps("nano", {"1403636579763555584.png"}) == Stamps{1403636579763555584});
  CHECK(stamps("micro", {"1403636579763555.png"}) == Stamps{1403636579763555000});
  CHECK(stamps("milli", {"1403636579763.png"}) == Stamps{1403636579763000000});
  // The steps tell the unit where the number of digits does not: nanoseconds since a boot 20 minutes or 12 days ago.
  CHECK(stamps("boot", {"1234567890123.png", "1234617890123.png"}) == Stamps{1234567890123, 1234617890123});
  CHECK(stamps("long boot", {"1036800000000000.png", "1036800050000000.png"}) ==
        Stamps{1036800000000000, 1036800050000000});
  CHECK(stamps("milli steps", {"1403636579763.png", "1403636579813.png"}) ==
        Stamps{1403636579763000000, 1403636579813000000});
  CHECK(stamps("numbers", {"000001.png", "000002.png"}).empty());
  CHECK(stamps("counter", {"0000000001.png", "0000000002.png"}).empty());
  CHECK(stamps("words", {"left_1.5.png"}).empty());
}

TEST_CASE("image list: times.txt and data.csv beside the images give the timestamps") {
  const TemporaryFolder folder;
  for (const char* name : {"1.png", "2.png", "10.png"}) dataset_files::write_image(folder / (std::string("a/") + name));
  write_text(folder / "times.txt", "# seconds\n0.0\n0.5\n1e0\n");
  auto images = list_images(folder / "a");
  CHECK(images.stamps_ns == std::vector<std::int64_t>{0, 500'000'000, 1'000'000'000});
  CHECK_THAT(images.files[2], Contains("10.png"));
  CHECK(images.stamps_from == (std::filesystem::path(folder / "a") / ".." / "times.txt").string());
  std::filesystem::rename(folder / "times.txt", folder / "timestamps.txt");  // as beside the data of KITTI's raw drives
  CHECK(data::list_images(folder / "a").stamps_ns == images.stamps_ns);
  std::filesystem::rename(folder / "timestamps.txt", folder / "times.txt");
  // A list takes precedence over times.txt and defines the order.
  write_text(folder / "a/data.csv", "#timestamp [ns],filename\n7,10.png\n9,1.png\n");
  images = list_images(folder / "a");
  CHECK(images.stamps_ns == std::vector<std::int64_t>{7, 9});
  CHECK_THAT(images.files[0], Contains("10.png"));
}

TEST_CASE("image list: inconsistent files are reported") {
  const TemporaryFolder folder;
  dataset_files::write_image(folder / "a/1.png");
  const auto complaint = [&] { return message_of([&] { list_images(folder / "a"); }); };
  write_text(folder / "a/times.txt", "0\n1\n");
  CHECK_THAT(complaint(), Contains("a/times.txt") && Contains("2 times") && Contains("the 1 image in"));
  write_text(folder / "a/times.txt", "0 1 2 3\n");
  CHECK_THAT(complaint(), Contains("times.txt:1"));
  CHECK(list_images(folder / "a", false).stamps_ns.empty());  // what nobody asks for is not read
  write_text(folder / "a/times.txt", "# name seconds exposure\n1 1520530308.199447626 1.46\n");
  CHECK(list_images(folder / "a").stamps_ns == std::vector<std::int64_t>{1520530308199447626});
  write_text(folder / "a/times.txt", "2011-09-26 13:02:25.967790592\n");
  CHECK(list_images(folder / "a").stamps_ns == std::vector<std::int64_t>{1317042145967790592});
  write_text(folder / "a/data.csv", "5,2.png\n");
  CHECK_THAT(complaint(), Contains("2.png") && Contains("data.csv"));
  write_text(folder / "a/data.csv", "5,1.png\n5,1.png\n");
  CHECK_THAT(complaint(), Contains("data.csv:2") && Contains("again"));
  write_text(folder / "a/data.csv", "5,../1.png\n");
  CHECK_THAT(complaint(), Contains("data.csv:1"));
  CHECK_THROWS_AS(list_images(folder / "absent"), DataError);
}

TEST_CASE("image list: timestamps are paired with the nearest ones") {
  using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
  // Half of the usual period of 10 is not reached by 4: 20 and 24 are a pair, 40 has none.
  const StampPairs found = pair_stamps({0, 10, 20, 30, 40}, {1, 11, 24, 29, 60});
  CHECK(found.pairs == Pairs{{0, 0}, {1, 1}, {2, 2}, {3, 3}});
  CHECK(found.largest_difference_ns == 4);
  CHECK(pair_stamps({0, 10, 20}, {1, 11, 24}, 3).pairs == Pairs{{0, 0}, {1, 1}});
  // Both left stamps are nearest to 11, which is nearest to 10; the order of the left stamps is kept.
  CHECK(pair_stamps({14, 10}, {11}).pairs == Pairs{{1, 0}});
  CHECK(pair_stamps({20, 10}, {10, 20}).pairs == Pairs{{0, 1}, {1, 0}});
  CHECK(pair_stamps({5}, {70}).pairs == Pairs{{0, 0}});
  CHECK(pair_stamps({5}, {}).pairs.empty());
}

TEST_CASE("image list: stamps may go back where that is asked for, and never repeat") {
  const TemporaryFolder folder;
  write_text(folder / "times.txt", "1.0\n2.0\n1.5\n");
  CHECK_THROWS_WITH(read_times(folder / "times.txt"), Contains("1.5") && Contains("after 2.0"));
  CHECK(read_times(folder / "times.txt", true) ==
        std::vector<std::int64_t>{1'000'000'000, 2'000'000'000, 1'500'000'000});
  write_text(folder / "times.txt", "1.0\n1.0\n");
  CHECK_THROWS_AS(read_times(folder / "times.txt", true), DataError);
}

TEST_CASE("image list: two files are separated by the comma that leaves two existing ones") {
  const TemporaryFolder folder;
  const std::string left = folder / "a,b/left.yaml", right = folder / "a,b/right.yaml";
  for (const auto& file : {left, right}) write_text(file, "");
  using Files = std::vector<std::string>;
  CHECK(file_list(left) == Files{left});
  CHECK(file_list(left + "," + right) == Files{left, right});
  CHECK(file_list("one,two") == Files{"one", "two"});
}

TEST_CASE("image list: TIFF and BMP are named, with a converter") {
  const TemporaryFolder folder;
  write_text(folder / "t/1.tif", std::string("II*\0\0\0\0\0", 8));
  write_text(folder / "b/1.png", "BM12345678");
  CHECK_THROWS_WITH(list_images(folder / "t"), Contains("1.tif") && Contains("mogrify"));
  CHECK_THROWS_WITH(read_grey_image(folder / "b/1.png"), Contains("a BMP image") && Contains("mogrify"));
  CHECK_THROWS_WITH(read_grey_image(folder / "t/1.tif"), Contains("a TIFF image"));
}

TEST_CASE("image list: numbers of names that jump are told") {
  const auto names = [](int first, int count) {
    std::vector<std::string> files;
    for (int i = first; i < first + count; ++i)
      files.push_back("left/IMG_" + std::to_string(10'000 + i).substr(1) + ".png");
    return files;
  };
  std::vector<std::string> all = names(1, 20);
  CHECK(number_jump(all).empty());
  const auto before = names(9'980, 20);  // recorded first; the camera goes on with IMG_0001
  all.insert(all.end(), before.begin(), before.end());
  CHECK_THAT(number_jump(all), Contains("jump from IMG_0020.png to IMG_9980.png, usually by 1"));
  CHECK_THAT(number_jump({"4294.png", "37590.png", "4294900000.png", "4294933296.png", "4294966592.png"}),
             Contains("from 37590.png to 4294900000.png, usually by 33296"));
  CHECK(number_jump({"one.png", "two.png", "three.png"}).empty());
}
