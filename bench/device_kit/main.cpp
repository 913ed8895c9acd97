/// \file main.cpp  device_check: what the device kit measures, without OpenCV, JSON library or network.
/// scripts/device_kit.sh builds the kit; its run.sh calls this program part by part.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <map>

#include "device_kit/parts.hpp"
#include "quadedge/error.hpp"

namespace device_kit {

using quadedge::UsageError;

Device Options::open_device(bool profiling) const {
  quadedge::DeviceOptions options;
  options.profiling = profiling;
  options.program_folder = programs;
  return Device(device, options);
}

const std::string& Options::argument(std::size_t index) const {
  if (index >= arguments.size()) throw UsageError("an argument is missing");
  return arguments[index];
}

Sequence Options::sequence() const { return read_sequence(data + "/" + argument(0)); }

Config Options::preset(const std::string& name) const {
  const auto presets = read_presets(data + "/presets");
  const auto found = presets.find(name);
  if (found == presets.end()) throw UsageError("there is no preset " + name);
  return found->second;
}

namespace {

constexpr const char* kUsage =
    "usage: device_check PART ROWS [ARGUMENT...]\n"
    "  device, self-test cold|kept, programs, variants SEQUENCE, bench SEQUENCE PRESET SECONDS,\n"
    "  compare SEQUENCE, record SEQUENCE        add rows to the file ROWS\n"
    "  row TABLE COLUMN=VALUE...                adds one row\n"
    "  name                                     prints the device: \"gpu: NAME, DRIVER\"\n"
    "  page FILE COLUMN=VALUE...                writes a page (Markdown) from the rows\n"
    "Environment: DEVICE_KIT_DATA, folder of the sequences; DEVICE_KIT_PROGRAMS, folder of built programs;\n"
    "DEVICE_KIT_DEVICE, auto without it.\n";

/// COLUMN=VALUE from the second argument on.
Row given_row(const std::vector<std::string>& arguments) {
  Row row;
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const auto equals = arguments[i].find('=');
    if (equals == std::string::npos) throw UsageError(arguments[i] + ": expected COLUMN=VALUE");
    row.emplace_back(arguments[i].substr(0, equals), arguments[i].substr(equals + 1));
  }
  return row;
}

void write_page(const Options& options, const std::string& rows) {
  const Row origin = given_row(options.arguments);
  std::ofstream page(options.argument(0));
  if (!(page << markdown_page(rows, origin)).flush())
    throw quadedge::DataError(options.argument(0) + ": cannot be written");
}

std::string environment(const char* name, const char* otherwise) {
  const char* value = std::getenv(name);
  return value == nullptr ? otherwise : value;
}

int run(int count, char** values) {
  if (count < 3) throw UsageError("a part and a file of rows are needed");
  const std::string part = values[1], rows = values[2];
  const Options options{Rows(rows),
                        environment("DEVICE_KIT_DEVICE", "auto"),
                        environment("DEVICE_KIT_PROGRAMS", ""),
                        environment("DEVICE_KIT_DATA", "."),
                        {values + 3, values + count}};
  static const std::map<std::string, void (*)(const Options&)> parts = {
      {"device", device_part}, {"self-test", self_test_part}, {"programs", programs_part}, {"variants", variants_part},
      {"bench", bench_part},   {"compare", compare_part},     {"record", record_part}};
  const auto found = parts.find(part);
  if (found != parts.end()) {
    found->second(options);
  } else if (part == "row") {
    options.rows.add(options.argument(0), given_row(options.arguments));
  } else if (part == "name") {
    const auto info = options.open_device(false).info();
    std::printf("%s: %s, %s\n", info.type.c_str(), info.name.c_str(), info.driver.c_str());
  } else if (part == "page") {
    write_page(options, rows);
  } else {
    throw UsageError("there is no part " + part);
  }
  return 0;
}

}  // namespace
}  // namespace device_kit

int main(int count, char** values) {
  try {
    return device_kit::run(count, values);
  } catch (const quadedge::UsageError& error) {
    std::fprintf(stderr, "device_check: %s\n%s", error.what(), device_kit::kUsage);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "device_check: %s\n", error.what());
    return 1;
  }
}
