#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "program.hpp"

namespace fs = std::filesystem;

TEST_CASE("edges: the table has a header, six decimals, and only edges inside the image", "[cli][device]") {
  const TemporaryFolder folder;
  std::string image;
  for (const auto& entry : fs::directory_iterator(small_sequence() + "/rgb")) image = entry.path().string();
  run_well({"edges", image, "--csv", folder / "e.csv", "--draw", folder / "e.png"});
  const auto rows = read_lines(folder / "e.csv");
  REQUIRE(rows.size() > 100);
  CHECK(rows[0] == "x,y,direction_rad,strength");
  for (std::size_t i = 1; i < rows.size(); ++i) {
    double x, y, direction, strength;
    int length = 0;
    REQUIRE(std::sscanf(rows[i].c_str(), "%lf,%lf,%lf,%lf%n", &x, &y, &direction, &strength, &length) == 4);
    REQUIRE(length == static_cast<int>(rows[i].size()));
    REQUIRE(rows[i].size() - rows[i].rfind('.') == 7);
    REQUIRE((x > 0 && x < 319 && y > 0 && y < 199));
    REQUIRE(std::abs(direction) <= 3.141593);  // pi, rounded
    REQUIRE(strength > 1.9);                   // the threshold applies at the pixel, the strength is that of the edge
  }
  CHECK(fs::file_size(folder / "e.png") > 1000);
  check_error({"edges", image, "--csv", folder / "e.csv"}, 2);
  check_error({"edges", image, "--csv", folder / "absent/e.csv"}, 3);
}
