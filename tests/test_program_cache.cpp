/// \file test_program_cache.cpp  The cache of built programs on disk: storing, finding and checking them.
#include "device/kernel.hpp"
#include "device/program_cache.hpp"
#include "testing.hpp"

using namespace quadedge;
using opencl::ProgramCache;

namespace {

ProgramCache::Binary binary_of(std::size_t size, unsigned char first) {
  ProgramCache::Binary binary(size);
  for (std::size_t i = 0; i < size; ++i) binary[i] = static_cast<unsigned char>(first + 7 * i);
  return binary;
}

void change_byte(const std::string& path, std::streamoff from_end) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekg(-from_end, std::ios::end);
  const char byte = static_cast<char>(file.get() ^ 1);
  file.seekp(-from_end, std::ios::end);
  file.put(byte);
}

}  // namespace

TEST_CASE("program cache: returns what was stored, and nothing for another key", "[opencl]") {
  const TemporaryFolder folder;
  const ProgramCache cache(folder / "programs"), nowhere("");
  const auto binary = binary_of(1000, 3), empty = ProgramCache::Binary();
  CHECK_FALSE(cache.find("a"));
  cache.keep("a", binary);
  cache.keep("b", empty);
  CHECK(cache.find("a") == binary);
  CHECK(cache.find("b") == empty);
  CHECK_FALSE(cache.find("c"));
  cache.keep("a", empty);
  CHECK(cache.find("a") == empty);
  nowhere.keep("a", binary);
  CHECK_FALSE(nowhere.find("a"));
}

TEST_CASE("program cache: damaged files and files of other keys are ignored", "[opencl]") {
  const TemporaryFolder folder;
  const ProgramCache cache(folder / "programs");
  cache.keep("a", binary_of(1000, 3));
  cache.keep("b", binary_of(1000, 4));
  const auto from_end = GENERATE(1, 500, 1000, 1001, 1010);  // in the binary, in the key, in a number before it
  SECTION("changed byte") {
    change_byte(cache.path("a"), from_end);
    CHECK_FALSE(cache.find("a"));
  }
  SECTION("truncated") {
    std::filesystem::resize_file(cache.path("a"), std::filesystem::file_size(cache.path("a")) - from_end);
    CHECK_FALSE(cache.find("a"));
  }
  SECTION("another key") {
    std::filesystem::copy_file(cache.path("b"), cache.path("a"), std::filesystem::copy_options::overwrite_existing);
    CHECK_FALSE(cache.find("a"));
  }
}

TEST_CASE("program cache: a reader sees a complete binary while another thread writes", "[opencl]") {
  const TemporaryFolder folder;
  const ProgramCache cache(folder / "programs");
  const auto one = binary_of(200000, 1), other = binary_of(200000, 2);
  cache.keep("a", one);
  std::thread writer([&] {
    for (int i = 0; i < 50; ++i) cache.keep("a", i % 2 == 0 ? other : one);
  });
  int torn = 0;
  for (int i = 0; i < 200; ++i) {
    const auto found = cache.find("a");
    torn += found && (*found == one || *found == other) ? 0 : 1;
  }
  writer.join();
  CHECK(torn == 0);
}

TEST_CASE("program cache: a context uses a stored program and rebuilds a damaged one", "[opencl]") {
  const auto name = GENERATE(from_range(all_devices()));
  const TemporaryFolder folder;
  DeviceOptions options;
  options.program_folder = folder / "programs";
  if (Device(name, options).info().platform == "Portable Computing Language") {
    // It caches kernels itself, and to hand out a program it compiles all of its kernels once more.
    Device device(name, options);
    device.context()->program({"undistortion.cl"}, {});
    CHECK_FALSE(std::filesystem::exists(folder / "programs"));
    return;
  }
  const auto undistort = [&] {
    Device device(name, options);
    const auto program = device.context()->program({"undistortion.cl"}, {});
    return cl::Kernel(program, "undistort").getInfo<CL_KERNEL_NUM_ARGS>();
  };
  const auto arguments = undistort();
  std::string file;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "programs")) file = entry.path().string();
  REQUIRE_FALSE(file.empty());
  const auto kept = std::filesystem::last_write_time(file);
  CHECK(undistort() == arguments);
  change_byte(file, 1);
  CHECK(undistort() == arguments);
  CHECK(std::filesystem::last_write_time(file) > kept);
  std::ofstream(file) << "something else";
  CHECK(undistort() == arguments);
  CHECK(std::filesystem::file_size(file) > 1000);
}
