/// \file test_kernel_signatures.cpp  Kernels and their host signatures, drivers that report other type names, and
/// groups that are too large for a kernel.
#include "device/kernel.hpp"
#include "device/stage.hpp"
#include "frontends.hpp"
#include "kernel_programs.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;
using opencl::argument_difference;
using opencl::canonical_type;

TEST_CASE("kernels: all spellings of a type are the same type", "[opencl]") {
  for (const auto* spelling : {"uint*", "uint *", "unsigned int*", "const unsigned int *", "__global const uint*",
                               "global unsigned*", "uint* restrict", "unsigned int __restrict *"})
    CHECK(canonical_type(spelling) == "uint*");
  for (const auto* spelling : {"FilterArguments", "struct FilterArguments", "const struct FilterArguments",
                               "struct.FilterArguments", "__private FilterArguments"})
    CHECK(canonical_type(spelling) == "FilterArguments");
  for (const auto* spelling : {"int", "signed int", "signed", "const int"}) CHECK(canonical_type(spelling) == "int");
  CHECK(canonical_type("signed char*") == "char*");
  CHECK(canonical_type("unsigned char") == "uchar");
  CHECK(canonical_type("short int") == "short");
  CHECK(canonical_type("long unsigned int") == "ulong");
  std::set<std::string> different;
  for (const auto* type : {"int", "uint", "char", "uchar", "short", "ushort", "float", "int*", "int**", "Int"})
    different.insert(canonical_type(type));
  CHECK(different.size() == 10);
}

TEST_CASE("kernels: arguments differ by type, address space or const, but never by unreported properties", "[opencl]") {
  const opencl::ArgumentType read{"uint*", true, true}, number{"int", false, false};
  CHECK(argument_difference({"a", "unsigned int *", true, true}, read).empty());
  CHECK(argument_difference({"a", "const uint*", true, false}, read).empty());
  CHECK(argument_difference({"a", "", false, false}, read).empty());
  CHECK(argument_difference({"n", "const int", false, true}, number).empty());
  CHECK_THAT(argument_difference({"a", "uint*", true, false}, read),
             Contains("(a)") && Contains("global uint*") && Contains("global const uint*"));
  CHECK_FALSE(argument_difference({"a", "int*", true, true}, read).empty());
  CHECK_FALSE(argument_difference({"a", "uint*", false, true}, read).empty());
  CHECK_FALSE(argument_difference({"n", "float", false, false}, number).empty());
}

TEST_CASE("kernels: a wrong host signature is reported with the argument's name", "[device]") {
  for (const auto& index : all_devices()) {
    Device device(index);  // a cached program may lack argument names
    auto& context = *device.context();
    const auto program = context.program({"undistortion.cl"}, {});
    const auto faults_of = [&](const auto& signature) {
      context.check_kernels(true);
      const std::size_t before = context.kernel_faults().size();
      std::decay_t<decltype(signature)>(context, program, "undistort");
      std::string text;
      for (std::size_t i = before; i < context.kernel_faults().size(); ++i) text += context.kernel_faults()[i];
      return text;
    };
    using Right =
        opencl::Kernel<void(const cl_uint*, cl_int, cl_int, const cl_float*, const cl_float*, cl_uchar*, cl_int)>;
    using FloatForInt =
        opencl::Kernel<void(const cl_uint*, cl_int, cl_int, const cl_float*, const cl_float*, cl_uchar*, cl_float)>;
    using Writable =
        opencl::Kernel<void(cl_uint*, cl_int, cl_int, const cl_float*, const cl_float*, cl_uchar*, cl_int)>;
    using TooFew = opencl::Kernel<void(const cl_uint*)>;
    CHECK(faults_of(Right()).empty());
    CHECK_THAT(faults_of(FloatForInt()), Contains("count") && Contains("float") && Contains("int"));
    CHECK_THAT(faults_of(Writable()), Contains("corners") && Contains("const"));
    CHECK_THAT(faults_of(TooFew()), Contains("7 arguments"));
    CHECK_THROWS_AS(Right(context, program, "no_such_kernel"), DeviceError);
    context.check_kernels(false);
    CHECK_NOTHROW(FloatForInt(context, program, "undistort"));
  }
}

TEST_CASE("kernels: every kernel of every variant has its host signature", "[device]") {
  const matching::RenderedScene scene("room", 96, 64, 1);
  Config config = scene.config;
  config.stereo.sift_max = 500;  // so that every kernel is used
  StereoRig rig = scene.rig;
  const auto pixels = static_cast<std::size_t>(rig.left.width * rig.left.height);
  rig.left_undistortion = rig.right_undistortion = {rig.left.width, rig.left.height, std::vector<float>(pixels),
                                                    std::vector<float>(pixels)};
  rig.left_mask = {rig.left.width, rig.left.height, std::vector<std::uint8_t>(pixels, 1)};
  for (const auto& index : all_devices()) {
    DeviceOptions options = kept_programs();
    options.profiling = true;
    Device device(index, options);
    auto& context = *device.context();
    context.check_kernels(true);
    bool any = true;
    for (std::size_t wanted = 0; any; ++wanted) {
      any = false;
      std::map<std::string, std::size_t> seen;
      for (const auto& variant : opencl::all_variants()) {
        if (seen[variant.stage]++ != wanted) continue;
        config.variants[variant.stage] = variant.name;
        any = true;
      }
      frontend::make_frontend(rig, device, config);
    }
    stages::long_loop_difference(context, 10);
    for (const auto& fault : context.kernel_faults()) FAIL_CHECK(fault);
  }
}

TEST_CASE("kernels: a driver with other type names passes the self-test and tracks", "[device][selftest]") {
  const TemporaryFolder folder;
  std::filesystem::copy(QUADEDGE_KERNELS, folder / "kernels");
  // The same bits under a type name that the host does not expect.
  std::string text = read_text(folder / "kernels/undistortion.cl");
  const std::string what = "const int count", by = "const uint count";
  REQUIRE(text.find(what) != std::string::npos);
  std::ofstream(folder / "kernels/undistortion.cl") << text.replace(text.find(what), what.size(), by);
  DeviceOptions options;
  options.kernel_folder = folder / "kernels";
  Device device(all_devices().front(), options);
  const SelfTestResult result = self_test(device);
  INFO(result.stage << ": " << result.difference);
  CHECK(result.passed());
  REQUIRE_FALSE(device.context()->kernel_faults().empty());
  CHECK_THAT(device.context()->kernel_faults().front(), Contains("undistort") && Contains("uint"));
  CHECK_FALSE(device.context()->checks_kernels());
}

TEST_CASE("kernels: a query that the driver refuses is a DeviceError", "[device]") {
  Device device(all_devices().front());
  CHECK_THROWS_AS(opencl::check_local_memory(cl::Kernel(), "nothing", *device.context()), DeviceError);
  CHECK_THROWS_AS(opencl::group_limit(cl::Kernel(), "nothing", *device.context()), DeviceError);
}

TEST_CASE("kernels: groups shrink for kernels without a required size, others are refused", "[device]") {
  opencl::DeviceLimits limits;
  limits.group_items = 16;
  for (const auto& index : all_devices()) {
    Device device = opencl::open_limited(index, {}, limits);
    auto& context = *device.context();
    const auto program =
        build_program(context, {},
                      "kernel void free_size(global int* out) { out[get_global_id(0)] = (int)get_local_size(0); }\n"
                      "kernel __attribute__((reqd_work_group_size(64, 1, 1))) void of_64(global int* out) {\n"
                      "  out[get_global_id(0)] = (int)get_local_size(0);\n}\n");
    opencl::Buffer<cl_int> sizes(context, 128);
    const opencl::Kernel<void(cl_int*)> free_size(context, program, "free_size");
    free_size({100, 64}, sizes);
    CHECK(sizes.read(112) == std::vector<cl_int>(112, 16));
    const opencl::Kernel<void(cl_int*)> of_64(context, program, "of_64");
    CHECK_THROWS_WITH(of_64({100, 64}, sizes), Contains("of_64") && Contains("CL_INVALID_WORK_GROUP_SIZE"));
  }
}

TEST_CASE("kernels: side patches and descriptors are read as aligned types, not with vload16", "[opencl]") {
  int readers = 0;
  for (const auto& [file, text] : opencl::embedded_kernels()) {
    const bool reads = text.find("patches") != std::string::npos || text.find("descriptor") != std::string::npos;
    if (!reads) continue;
    ++readers;
    INFO(file);
    CHECK(text.find("vload16(") == std::string::npos);
    CHECK(text.find("vload2(") == std::string::npos);
  }
  CHECK(readers > 8);
}
