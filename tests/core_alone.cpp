/// \file core_alone.cpp  A program that links quadedge_core alone: its devices work, the reference is elsewhere.

#include <cstdio>
#include <string>

#include "quadedge/error.hpp"
#include "quadedge/self_test.hpp"

int main() {
  using namespace quadedge;
  try {
    Device reference("reference");
  } catch (const DeviceError& error) {
    const bool is_named = std::string(error.what()).find("quadedge::quadedge ") != std::string::npos;
    Device device;
    const SelfTestResult result = self_test(device);
    std::printf("%s\nself-test: %s %s\n", error.what(), result.stage.c_str(), result.difference.c_str());
    return is_named && result.passed() ? 0 : 1;
  }
  std::printf("the core has a reference\n");
  return 1;
}
