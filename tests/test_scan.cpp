#include <catch2/catch.hpp>
#include <vector>

#include "device/stage.hpp"
#include "device/variants.hpp"
#include "devices.hpp"
#include "reference/candidates.hpp"

using namespace quadedge;

namespace {

void check_scan(const std::vector<int>& sizes, int capacity) {
  for_each_variant("scan", [&](opencl::Context& context, const Variants& variants) {
    stages::Scan scan(context, variants);
    for (const int size : sizes) {
      std::vector<cl_int> counts(static_cast<std::size_t>(size));
      for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = static_cast<cl_int>((i * 7919 + 13) % 5);
      opencl::Buffer<cl_int> device_counts(context, counts.size()), first, total;
      device_counts.write(context, counts);
      scan.run(device_counts, size, capacity, first, total);

      const reference::Scan expected = reference::scan(counts, capacity);
      INFO(size << " counts, capacity " << capacity);
      CHECK(first.read(counts.size() + 1) == expected.first);
      CHECK(total.read(2) == std::vector<cl_int>{expected.fitting, expected.cut_off});
    }
  });
}

}  // namespace

TEST_CASE("scan: the reference agrees with sums calculated by hand", "[scan]") {
  const reference::Scan free = reference::scan({3, 0, 2, 4}, 100), cut = reference::scan({3, 0, 2, 4}, 4);
  CHECK(free.first == std::vector<std::int32_t>{0, 3, 3, 5, 9});
  CHECK((free.fitting == 9 && free.cut_off == 0));
  CHECK(cut.first == std::vector<std::int32_t>{0, 3, 3, 4, 4});
  CHECK((cut.fitting == 4 && cut.cut_off == 5));
  CHECK(reference::scan({}, 4).first == std::vector<std::int32_t>{0});
}

TEST_CASE("scan: every device and variant gives the exclusive sums of small lists", "[scan][device][oclgrind]") {
  check_scan({0, 1, 2, 255, 256, 257, 1000}, 1 << 30);
}

TEST_CASE("scan: sums beyond the capacity are clamped and counted", "[scan][device][oclgrind]") {
  check_scan({1, 300, 1000}, 333);
  check_scan({300}, 0);
}

TEST_CASE("scan: a list just too long for one group is split between two", "[scan][device][oclgrind]") {
  check_scan({4097}, 1 << 30);
}

TEST_CASE("scan: long lists are split between several groups", "[scan][device]") {
  check_scan({4096, 4097, 70001}, 1 << 30);
  check_scan({70001}, 50000);
}
