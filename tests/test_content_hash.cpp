#include "data/content_hash.hpp"
#include "dataset_files.hpp"

using namespace quadedge;

TEST_CASE("content hash: the boundaries between values count") {
  data::ContentHash one, two, three;
  one.add("ab"), one.add("c");
  two.add("a"), two.add("bc");
  three.add("ab"), three.add("c");
  CHECK(one.hex() != two.hex());
  CHECK(one.hex() == three.hex());
  CHECK(one.hex().size() == 32);
}

TEST_CASE("content hash: every byte of a file counts") {
  const TemporaryFolder folder;
  write_text(folder / "a", std::string(10'000, 'x'));
  const std::string before = data::file_hash(folder / "a");
  CHECK(data::file_hash(folder / "a") == before);
  write_text(folder / "a", std::string(5'000, 'x') + "y" + std::string(4'999, 'x'));
  CHECK(data::file_hash(folder / "a") != before);
}
