#include "device/stage.hpp"
#include "reference/candidates.hpp"
#include "stage_rows.hpp"

using namespace quadedge;

namespace {

void check_scan(const std::vector<int>& sizes, int capacity) {
  check_stage("scan", [&](opencl::Context& context, const Variants& variants) {
    stages::Scan scan(context, variants);
    StageArrays arrays;
    for (const int size : sizes) {
      std::vector<cl_int> counts(static_cast<std::size_t>(size));
      for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = static_cast<cl_int>((i * 7919 + 13) % 5);
      opencl::Buffer<cl_int> on_device, first, total;
      on_device.write(context, counts);
      scan.run(on_device, size, capacity, first, total);
      const reference::Scan truth = reference::scan(counts, capacity);
      const std::string name = std::to_string(size) + " counts: ";
      arrays.emplace_back(name + "first", first.read(counts.size() + 1), truth.first);
      arrays.emplace_back(name + "total", total.read(2), std::vector{truth.fitting, truth.cut_off});
    }
    return arrays;
  });
}

}  // namespace

TEST_CASE("scan: every device and variant gives the exclusive sums, clamped at the capacity", "[device][oclgrind]") {
  check_scan({0, 1, 2, 255, 256, 257, 1000, 4097}, 1 << 30);  // 4097: just too long for one group
  check_scan({1, 300, 1000}, 333);
  check_scan({300}, 0);
}

TEST_CASE("scan: long lists are split between several groups", "[device]") {
  check_scan({4096, 70001}, 1 << 30);
  check_scan({70001}, 50000);
}
