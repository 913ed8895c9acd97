#include "device/kernel.hpp"
#include "kernel_programs.hpp"
#include "matching.hpp"
#include "reference/edge_descriptions.hpp"

using namespace quadedge;
using namespace matching;
using reference::cut_patch;
using reference::patch_derivative;
using reference::patch_frame;

TEST_CASE("photometric: patches hold the mean-free texture at their frame's positions") {
  const Image image = image_of(64, 60, [](double x, double y) { return 3 * x + y; });  // bilinear is exact
  const double angle = 0.4, c = std::cos(angle), s = std::sin(angle);
  const auto dark = cut_patch(image.view(), patch_frame(30, 25, c, s, 1, 5), 0, 0);
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 7; ++j) {  // on a plane the mean equals the middle sample
      const double along = 1.5 * (i - 2), x = along * c - (j - 3) * s, y = along * s + (j - 3) * c;
      CHECK(dark[static_cast<std::size_t>(7 * i + j)] == Approx(3 * x + y).margin(1e-9));
    }
  }
  // The frame's centre: the dark side lies at (sin, -cos), the bright one opposite.
  const auto frame = patch_frame(30, 25, c, s, -1, 5);
  CHECK(frame.x + 3 * c - 3 * s == Approx(30 - 5 * s));
  CHECK(frame.y + 3 * s + 3 * c == Approx(25 + 5 * c));
  // A plane's derivative is constant and vanishes with the mean; a product's does not.
  for (const double d : patch_derivative(image.view(), frame, 0.6, 0.8)) CHECK(d == Approx(0).margin(1e-9));
  const Image saddle = image_of(64, 60, [](double x, double y) { return 0.1 * (x - 32) * (y - 30) + 128; });
  const auto level = patch_frame(32, 30, 1, 0, 1, 5);
  const auto slope = patch_derivative(saddle.view(), level, 1,
                                      0);  // d/dx = 0.1 (y - 30), minus its mean; 8-bit rounding up to 0.5 / px
  for (int j = 0; j < 7; ++j) CHECK(slope[static_cast<std::size_t>(7 * 2 + j)] == Approx(0.1 * (j - 3)).margin(1.01));
}

TEST_CASE("photometric: devices sample the same patches, also across the border", "[device][oclgrind]") {
  const std::string source =
      "kernel void probe(global const uint* corners, const int width, const int height, global const float* at, const "
      "int count,\n"
      "                  global float* grey) {\n"
      "  const int i = (int)get_global_id(0);\n"
      "  if (i >= count) return;\n"
      "  float8 rows[kPatchRows];\n"
      "  float cosine;\n"
      "  const float sine = sine_cosine(at[4 * i + 2], &cosine);\n"
      "  cut_patch(corners, width, height, patch_frame(at[4 * i], at[4 * i + 1], cosine, sine, at[4 * i + 3], 5.0f), "
      "0.25f, -0.5f, rows);\n"
      "  for (int k = 0; k < kPatchRows; ++k) vstore8(rows[k], k, grey + 40 * i);\n"
      "}\n";
  for (const auto& [width, height] : {std::pair(27, 21), std::pair(2, 2), std::pair(3, 31)}) {
    const Image image = image_of(width, height, [](double x, double y) { return 128 + 100 * std::sin(3 * x + 5 * y); });
    Random random(11);
    std::vector<float> at = {-300, -50, 1, 1, 500, 1000, 2, -1};
    for (int k = 0; k < 20; ++k) {
      const double values[4] = {random(-12, width + 11), random(-12, height + 11), random(-kPi, kPi),
                                k % 2 == 0 ? 1.0 : -1.0};
      for (const double v : values) at.push_back(static_cast<float>(v));
    }
    const std::size_t count = at.size() / 4;
    for (const auto& index : all_devices()) {
      Device device(index, kept_programs());
      auto& context = *device.context();
      const auto program = build_program(context, {"direction.cl", "photometric.cl"}, source);
      opencl::Kernel<void(const cl_uint*, cl_int, cl_int, const cl_float*, cl_int, cl_float*)> kernel(context, program,
                                                                                                      "probe");
      stages::PixelCorners corners(context);
      corners.prepare(upload(context, image).pixels, width, height);
      opencl::Buffer<cl_float> positions, grey(context, 40 * count);
      positions.write(context, at);
      kernel({count, 1}, corners.values(), width, height, positions, static_cast<cl_int>(count), grey);
      const auto found = grey.read(40 * count);
      for (std::size_t i = 0; i < count; ++i) {
        const auto frame =
            patch_frame(at[4 * i], at[4 * i + 1], std::cos(at[4 * i + 2]), std::sin(at[4 * i + 2]), at[4 * i + 3], 5);
        const auto truth = cut_patch(image.view(), frame, 0.25, -0.5);
        double largest = 0;
        for (std::size_t k = 0; k < truth.size(); ++k)
          largest = std::max(largest, std::abs(truth[k] - static_cast<double>(found[40 * i + 8 * (k / 7) + k % 7])));
        INFO(width << " x " << height << ", patch " << i);
        CHECK(largest < 5e-3);  // 1e-5 px of rounding times up to 255 grey levels per px
      }
    }
  }
}
