#define XXH_INLINE_ALL  // header-only
#include <xxhash.h>

#include "saved_maps.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;

namespace {

constexpr std::size_t kHeaderBytes = 36, kSettings = 3;

/// A map file with these contents and a header that fits them, unless a part is given. doc/method.md section 10 states
/// the layout.
std::string framed(const std::string& bytes, std::uint32_t version = 2) {
  const std::uint64_t size = bytes.size();
  std::string text("\x89QEMAP\r\n", 8);
  text.append(reinterpret_cast<const char*>(&version), 4).append(reinterpret_cast<const char*>(&size), 8);
  XXH128_canonical_t sum;
  XXH128_canonicalFromHash(&sum, XXH3_128bits(bytes.data(), bytes.size()));
  return text.append(reinterpret_cast<const char*>(sum.digest), 16) + bytes;
}

template <class T>
std::string replaced(std::string bytes, std::size_t place, T value) {
  std::memcpy(bytes.data() + place, &value, sizeof value);
  return bytes;
}

/// Number of bytes of the settings.
std::size_t bytes_of_settings(const std::string& bytes) {
  std::size_t place = 4;
  for (std::size_t text = 0; text < 2 * kSettings; ++text) {
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + place, sizeof length);
    place += 4 + length;
  }
  return place;
}

void check_refused_map(const std::string& text, const std::string& words) {
  const TemporaryFolder folder;
  write_text(folder / "bad.map", text);
  INFO(words);
  REQUIRE_THROWS_AS(read_map(folder / "bad.map"), DataError);
  REQUIRE_THROWS_WITH(read_map(folder / "bad.map"), Contains("bad.map") && Contains(words) && Contains("expected"));
}

}  // namespace

TEST_CASE("saved map: written, read and written again it has the same bytes", "[device]") {
  const SavedMap& map = saved_maps::room_map();
  REQUIRE(map.key_rigs() > 1);
  const TemporaryFolder folder;
  write_map(folder / "a.map", map);
  const SavedMap again = read_map(folder / "a.map");
  write_map(folder / "b.map", again);
  CHECK(read_text(folder / "a.map") == read_text(folder / "b.map"));
  CHECK(again.key_rigs() == map.key_rigs());
  CHECK(again.rig().left.matrix() == map.rig().left.matrix());
  CHECK(again.rig().right_from_left.matrix() == map.rig().right_from_left.matrix());
  // At most half a megabyte per keyframe.
  CHECK(static_cast<double>(std::filesystem::file_size(folder / "a.map")) < 5e5 * static_cast<double>(map.key_rigs()));
}

TEST_CASE("saved map: files that are cut, damaged, foreign or of another version are refused", "[device]") {
  const std::string bytes = saved_maps::room_map().bytes(), whole = framed(bytes);
  {
    const TemporaryFolder folder;
    write_text(folder / "good.map", whole);
    REQUIRE_NOTHROW(read_map(folder / "good.map"));
  }
  check_refused_map("", "another kind");
  check_refused_map("solid cube\n" + std::string(100, ' '), "another kind");
  check_refused_map(replaced(whole, 0, 'x'), "another kind");
  check_refused_map(whole.substr(0, kHeaderBytes - 1), "another kind");
  check_refused_map(framed(bytes, 1), "version 1");
  check_refused_map(replaced(whole, 12, std::uint64_t{1} << 60), "1152921504606846976");
  check_refused_map(whole.substr(0, whole.size() - 1), "bytes of the map");
  check_refused_map(whole + "x", "bytes of the map");
  check_refused_map(replaced(whole, 20, static_cast<char>(whole[20] + 1)), "checksum");
  for (const std::size_t place : {kHeaderBytes, whole.size() / 2, whole.size() - 1})
    check_refused_map(replaced(whole, place, static_cast<char>(whole[place] ^ 1)), "checksum");
  const TemporaryFolder folder;
  REQUIRE_THROWS_AS(read_map(folder / "absent.map"), DataError);
  REQUIRE_THROWS_AS(read_map(folder.path()), DataError);
}

TEST_CASE("saved map: contents that promise more than there is or hold impossible values are refused", "[device]") {
  const std::string bytes = saved_maps::room_map().bytes();
  const std::size_t rig = bytes_of_settings(bytes), poses = rig + 2 * 40 + 128 + 4 + 1 + 16;
  const std::size_t places = poses + 4 + saved_maps::room_map().key_rigs() * 128;
  const std::size_t count = places + 4 + 4 + 8 + 1024, column = count + 4;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();
  const auto refused = [&](std::size_t place, auto value, const std::string& words) {
    check_refused_map(framed(replaced(bytes, place, value)), words);
  };
  refused(0, std::uint32_t{0xFFFFFFFF}, "more bytes");
  refused(4, std::uint32_t{0xFFFFFFFF}, "more bytes");
  refused(rig, kNan, "focal length");
  refused(rig + 32, std::int32_t{1 << 30}, "image size");
  refused(rig + 32, std::int32_t{-5}, "image width");
  refused(rig + 80, 2.0, "rotation");
  refused(rig + 80 + 96, kNan, "baseline");
  refused(rig + 80 + 104, kNan, "baseline");
  refused(rig + 80 + 112, kInfinity, "baseline");
  refused(rig + 80 + 40, kNan, "rotation");
  refused(rig + 208, std::int32_t{0}, "pixel value");
  refused(rig + 212, std::uint8_t{2}, "lens distortion");
  refused(rig + 213, kNan, "disparity offset");
  refused(rig + 221, -1.0, "variance");
  refused(rig + 221, 1e-320, "variance");
  refused(rig + 221, kNan, "variance");
  refused(poses, std::uint32_t{0xFFFFFFFF}, "more bytes");
  refused(poses, std::uint32_t{1}, "");  // what follows is no list of keyframes
  refused(poses + 4, 3.0, "pose");
  refused(poses + 4 + 96, 1e300, "pose");
  for (const std::size_t element : {96, 104, 112}) refused(poses + 4 + element, kNan, "pose");
  for (const std::size_t element : {8, 40, 80}) refused(poses + 4 + element, kNan, "pose");
  refused(poses + 4 + 104, kInfinity, "pose");
  refused(places, std::uint32_t{0xFFFFFFFF}, "more bytes");
  refused(places + 4, std::int32_t{-1}, "frame number");
  refused(places + 8, kNan, "spacing");
  refused(places + 16, 5.0F, "signature");
  refused(count, std::uint32_t{0xFFFFFFFF}, "more bytes");
  refused(count, std::uint32_t{0}, "");
  refused(column, std::numeric_limits<float>::quiet_NaN(), "edge");
  refused(column, -1.0F, "edge");
  check_refused_map(framed(bytes + "x"), "after the map");
  check_refused_map(framed(bytes.substr(0, bytes.size() - 1)), "more bytes");
}

TEST_CASE("saved map: the settings it was made with are required, and shown without control characters", "[device]") {
  const std::string bytes = saved_maps::room_map().bytes();
  Device device("0", kept_programs());
  const auto locate_in = [&](const std::string& changed) {
    const SavedMap map = SavedMap::from_bytes(changed, "changed.map");
    Localiser(map, map.rig(), device, Config());
  };
  REQUIRE_NOTHROW(locate_in(bytes));
  const std::string without = std::string(4, '\0') + bytes.substr(bytes_of_settings(bytes));
  REQUIRE_THROWS_WITH(locate_in(without), Contains("does not state its edges.sigma"));
  std::size_t value = 4 + 4;
  while (bytes.compare(value, 11, "edges.sigma") != 0) ++value;
  const std::size_t digit = value + 11 + 4;
  REQUIRE(bytes[digit] == '2');
  REQUIRE_THROWS_WITH(locate_in(replaced(bytes, digit, '\x1b')), Contains("edges.sigma = \\x1b: expected the same"));
}

TEST_CASE("saved map: one that cannot be written is an error and leaves nothing behind", "[device]") {
  const TemporaryFolder folder;
  REQUIRE_THROWS_AS(write_map(folder / "absent/a.map", saved_maps::room_map()), DataError);
  REQUIRE_THROWS_AS(write_map("/dev/full", saved_maps::room_map()), DataError);
  CHECK(std::filesystem::is_empty(folder.path()));
}
