/// \file tests_main.cpp  quadedge_device_tests: the device tests that need the core alone. Writes what becomes of every
/// test to the file that DEVICE_KIT_TEST_LOG names, a line before and after it, and ends the process where a test takes
/// longer than DEVICE_KIT_TEST_SECONDS: the next call goes on with the tests after it.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <unistd.h>

namespace {

class Log : public Catch::TestEventListenerBase {
 public:
  using TestEventListenerBase::TestEventListenerBase;

  void testCaseStarting(const Catch::TestCaseInfo& info) override {
    TestEventListenerBase::testCaseStarting(info);
    write("started\t" + info.name);
    const char* seconds = std::getenv("DEVICE_KIT_TEST_SECONDS");
    if (seconds != nullptr) alarm(static_cast<unsigned>(std::atoi(seconds)));
  }
  void testCaseEnded(const Catch::TestCaseStats& stats) override {
    alarm(0);
    write((stats.totals.assertions.allPassed() ? "passed\t" : "failed\t") + stats.testInfo.name);
    TestEventListenerBase::testCaseEnded(stats);
  }

 private:
  static void write(const std::string& line) {
    const char* file = std::getenv("DEVICE_KIT_TEST_LOG");
    if (file != nullptr) std::ofstream(file, std::ios::app) << line << std::endl;
  }
};
CATCH_REGISTER_LISTENER(Log)

}  // namespace
