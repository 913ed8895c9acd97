#include "benchmark/device_model.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "data/toml_file.hpp"
#include "quadedge/error.hpp"

namespace quadedge::bench {
namespace {

struct TextKey {
  const char* name;
  std::string DeviceModel::*value;
};
constexpr TextKey kTexts[] = {
    {"name", &DeviceModel::name}, {"source", &DeviceModel::source}, {"assumptions", &DeviceModel::assumptions}};

enum class Range { rate, share, cost };

struct NumberKey {
  const char* name;
  double DeviceModel::*value;
  Range range;
};
constexpr NumberKey kNumbers[] = {{"memory_gb_s", &DeviceModel::memory_gb_s, Range::rate},
                                  {"memory_attainable", &DeviceModel::memory_attainable, Range::share},
                                  {"arithmetic_gflop_s", &DeviceModel::arithmetic_gflop_s, Range::rate},
                                  {"arithmetic_attainable", &DeviceModel::arithmetic_attainable, Range::share},
                                  {"transfer_gb_s", &DeviceModel::transfer_gb_s, Range::rate},
                                  {"transfer_attainable", &DeviceModel::transfer_attainable, Range::share},
                                  {"launch_us", &DeviceModel::launch_us, Range::cost},
                                  {"wait_us", &DeviceModel::wait_us, Range::cost},
                                  {"goal_ms", &DeviceModel::goal_ms, Range::rate}};

const char* expected(Range range) {
  switch (range) {
    case Range::rate: return "a number above 0";
    case Range::share: return "a share above 0 and up to 1";
    case Range::cost: return "a number of 0 or more";
  }
  return "";
}

bool is_within(double value, Range range) {
  if (!std::isfinite(value) || value < 0) return false;
  if (range == Range::cost) return true;
  return value > 0 && (range == Range::rate || value <= 1);
}

std::vector<std::string> all_keys() {
  std::vector<std::string> names;
  for (const auto& key : kTexts) names.emplace_back(key.name);
  for (const auto& key : kNumbers) names.emplace_back(key.name);
  return names;
}

void take(const data::TomlEntry& entry, DeviceModel& model) {
  for (const auto& key : kTexts) {
    if (entry.key != key.name) continue;
    data::assign(entry, model.*key.value);
    if ((model.*key.value).empty()) data::refuse(entry, "a text that is not empty");
    return;
  }
  for (const auto& key : kNumbers) {
    if (entry.key != key.name) continue;
    double& value = model.*key.value;
    if (std::holds_alternative<double>(entry.value) || std::holds_alternative<std::int64_t>(entry.value)) {
      data::assign(entry, value);
      if (is_within(value, key.range)) return;
    }
    data::refuse(entry, expected(key.range));
  }
  data::refuse_key(entry, all_keys());
}

DeviceModel read(const std::string& file) {
  DeviceModel model;
  model.file = file;
  std::set<std::string> given;
  for (const auto& entry : data::read_toml(file)) {
    take(entry, model);
    given.insert(entry.key);
  }
  const auto require = [&](const std::string& key, const std::string& what) {
    if (given.count(key) == 0) throw UsageError(file + ": " + key + " is missing; expected " + what);
  };
  for (const auto& key : kTexts) require(key.name, "a text in quotes");
  for (const auto& key : kNumbers) {
    if (key.value != &DeviceModel::goal_ms) require(key.name, expected(key.range));
  }
  return model;
}

}  // namespace

DeviceModel read_device_model(const std::string& file) {
  try {
    return read(file);
  } catch (const UsageError& error) {
    throw DataError(error.what());  // for a configuration it would be one of usage, but this is data
  }
}

}  // namespace quadedge::bench
