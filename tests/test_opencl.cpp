#include "device/kernel.hpp"
#include "testing.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;

TEST_CASE("devices: selection by number, type and text finds the same device", "[device]") {
  for (const auto& index : all_devices()) {
    const Device by_number(index);
    CHECK(Device(by_number.info().name).info().type == by_number.info().type);
    CHECK_FALSE(by_number.is_reference());
  }
  CHECK(Device("reference").is_reference());
  CHECK_NOTHROW(Device("auto"));
}

TEST_CASE("devices: a selection that matches nothing lists the available devices", "[device]") {
  CHECK_THROWS_WITH(Device("no such machine"), Contains("no such machine") && Contains(list_devices().at(0).name));
  CHECK_THROWS_AS(Device("99"), DeviceError);
}

TEST_CASE("kernels: a build error names file, line, device and options", "[device]") {
  const TemporaryFolder folder;
  for (const char* first : {"common.cl", "layouts.cl"}) std::ofstream(folder / first) << "// nothing\n";
  std::ofstream(folder / "broken.cl")
      << "// first line\nkernel void f(global int* a) {\n  a[0] = undeclared_name;\n}\n";
  DeviceOptions options;
  options.kernel_folder = folder.path();
  Device device(all_devices().front(), options);
  CHECK_THROWS_WITH(
      device.context()->program({"broken.cl"}, {{"LANES", "4"}}),
      Contains("broken.cl:3") && Contains("undeclared_name") && Contains("-DLANES=4") && Contains(device.info().name));
  CHECK_THROWS_WITH(device.context()->program({"absent.cl"}, {}), Contains("absent.cl"));
}

TEST_CASE("variants: unknown stages and names are refused with a list of the known ones", "[device]") {
  CHECK_THROWS_WITH(opencl::check_variants({{"nothing", "x"}}), Contains("undistortion"));
  CHECK_THROWS_WITH(opencl::check_variants({{"undistortion", "x"}}), Contains("item64"));
  CHECK_NOTHROW(opencl::check_variants({{"undistortion", "item64"}}));
}

TEST_CASE("buffers: memory is accounted for and reused", "[device]") {
  Device device(all_devices().front(), kept_programs());
  auto& context = *device.context();
  const auto before = context.bytes();
  {
    opencl::Buffer<cl_int> buffer(context, 100);
    CHECK(context.bytes() == before + 400);
    buffer.ensure(context, 50);
    CHECK(context.bytes() == before + 400);
    buffer.write(context, std::vector<cl_int>(200, 7));
    CHECK(context.bytes() == before + 900);  // with an eighth in reserve after growing
    CHECK(buffer.read(200) == std::vector<cl_int>(200, 7));
    buffer.fill(3, 100);
    CHECK(buffer.read(200)[99] == 3);
    CHECK(buffer.read(200)[100] == 7);
  }
  CHECK(context.bytes() == before);
  CHECK(context.peak_bytes() >= before + 800);
}
