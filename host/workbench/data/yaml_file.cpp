/// \file yaml_file.cpp  Adapts OpenCV's dialect to yaml-cpp, refuses duplicate keys, and converts numbers itself.
#include "data/yaml_file.hpp"

#include <algorithm>
#include <cmath>
#include <regex>
#include <set>

#include "data/layout.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

/// \throws DataError for a duplicate key in a map, because YAML readers differ in which one they use. Checks at most
/// `levels` nested maps and lists, which is as deep as files are read; aliases could make the recursion endless.
void check_keys(const YAML::Node& node, const std::string& file, int levels = 2) {
  if (levels == 0) return;
  if (node.IsSequence())
    for (const auto& item : node) check_keys(item, file, levels - 1);
  if (!node.IsMap()) return;
  std::set<std::string> keys;
  for (const auto& entry : node) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : std::string();
    if (!keys.insert(key).second) fail(file, entry.first.Mark().line + 1, "a second entry " + key, "each entry once");
    check_keys(entry.second, file, levels - 1);
  }
}

/// OpenCV's YAML and tabs in JSON as YAML: "%YAML:1.0" is no directive, and OpenCV reads "KEY:VALUE" without a space.
std::string without_dialect(std::string text) {
  if (const std::size_t header = text.find("%YAML:");
      header != std::string::npos && (header == 0 || text[header - 1] == '\n')) {
    text[header] = '#';
    static const std::regex tight("(^|\n)( *[A-Za-z_][A-Za-z_0-9.]*:)(?=[^\\s])");
    text = std::regex_replace(text, tight, "$1$2 ");
  }
  if (const std::size_t first = text.find_first_not_of(" \t\r\n");
      first != std::string::npos && (text[first] == '{' || text[first] == '['))
    std::replace(text.begin(), text.end(), '\t', ' ');
  return text;
}

}  // namespace

YAML::Node parse_yaml(const std::string& text, const std::string& file, const std::string& what) {
  try {
    YAML::Node node = YAML::Load(without_dialect(text));
    check_keys(node, file);
    return node;
  } catch (const YAML::Exception& problem) {
    fail(file, problem.mark.line + 1, "text that is not YAML (" + problem.msg + ")", what);
  }
}

YamlMap::YamlMap(const std::string& file, const std::string& what)
    : YamlMap(parse_yaml(read_text(file), file, what), file, what) {
  if (!node_.IsMap()) fail(file, "no entries", what);
}

YamlMap YamlMap::as(const std::string& what) const { return {node_, file_, what, prefix_}; }

std::vector<std::string> YamlMap::keys() const {
  std::vector<std::string> keys;
  for (const auto& entry : node_)
    if (entry.first.IsScalar()) keys.push_back(entry.first.Scalar());
  return keys;
}

void YamlMap::complain(const std::string& key, const std::string& found, const std::string& expected) const {
  fail(file_, line(key), found + " for " + name(key), expected);
}

YAML::Node YamlMap::entry(const std::string& key) const {
  if (!has(key)) fail(file_, "no entry " + name(key), what_);
  return node_[key];
}

YamlMap YamlMap::map(const std::string& key) const {
  const YAML::Node node = entry(key);
  if (!node.IsMap()) complain(key, "no entries", "a map");
  return {node, file_, what_, name(key) + "."};
}

std::vector<YamlMap::Item> YamlMap::items(const std::string& key) const {
  const YAML::Node list = entry(key);
  if (!list.IsSequence()) complain(key, "no list", "a list of maps");
  std::vector<Item> items;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const bool is_named = list[i].IsSequence() && list[i].size() == 2 && list[i][0].IsScalar();
    const YAML::Node inner = is_named ? list[i][1] : list[i];
    if (!inner.IsMap()) complain(key, "an item without entries", "a list of maps");
    const std::string label = is_named ? list[i][0].Scalar() : std::to_string(i);
    items.emplace_back(label, YamlMap(inner, file_, what_, name(key) + "[" + label + "]."));
  }
  return items;
}

double YamlMap::number(const std::string& key) const {
  const std::string text = word(key);
  return parse_number(text, file_, line(key), name(key));
}

std::string YamlMap::word(const std::string& key) const {
  const YAML::Node word = entry(key);
  return word.IsScalar() ? word.Scalar() : std::string();
}

/// Reads numbers without yaml-cpp's conversion, which depends on the locale.
void YamlMap::add_numbers(const YAML::Node& list, const std::string& expected, std::vector<double>& values) const {
  for (const YAML::Node& item : list) {
    const std::string token = item.IsScalar() ? item.Scalar() : std::string();
    values.push_back(parse_number(token, file_, item.Mark().line + 1, expected));
  }
}

std::vector<double> YamlMap::numbers(const std::string& key, std::optional<std::size_t> count) const {
  const YAML::Node list = entry(key);
  const std::string expected = name(key) + ": [" + (count ? std::to_string(*count) + " " : "") + "numbers]";
  if (!list.IsSequence()) fail(file_, line(key), "no list for " + name(key), expected);
  std::vector<double> values;
  add_numbers(list, expected, values);
  if (count && values.size() != *count) complain(key, std::to_string(values.size()) + " numbers", expected);
  return values;
}

std::vector<double> YamlMap::numbers_of(const std::vector<const char*>& names, const std::string& prefix) const {
  std::vector<double> values;
  for (const char* name : names) values.push_back(number(prefix + name));
  return values;
}

YamlMatrix YamlMap::matrix(const std::string& key) const {
  const YAML::Node node = entry(key);
  const std::string expected = name(key) + ": numbers";
  YamlMatrix matrix;
  if (node.IsMap()) {
    const YamlMap inner = map(key);
    const ImageSize shape = inner.size("cols", "rows");
    matrix.rows = static_cast<std::size_t>(shape.height);
    matrix.columns = static_cast<std::size_t>(shape.width);
    matrix.values = inner.numbers("data", matrix.rows * matrix.columns);
  } else if (node.IsSequence() && node.size() > 0 && node[0].IsSequence()) {
    matrix.rows = node.size();
    matrix.columns = node[0].size();
    for (const YAML::Node& row : node) {
      if (!row.IsSequence() || row.size() != matrix.columns) complain(key, "rows of unequal length", expected);
      add_numbers(row, expected, matrix.values);
    }
  } else if (node.IsSequence()) {
    add_numbers(node, expected, matrix.values);
  } else {
    for (const std::string& token : split(node.IsScalar() ? node.Scalar() : std::string()))
      matrix.values.push_back(parse_number(token, file_, line(key), expected));
  }
  return matrix;
}

std::vector<double> YamlMap::matrix(const std::string& key, std::size_t rows, std::size_t columns) const {
  const std::string shape = std::to_string(rows) + " x " + std::to_string(columns);
  YamlMatrix found = matrix(key);
  if (found.rows > 0 && (found.rows != rows || found.columns != columns))
    complain(key, "a matrix of " + std::to_string(found.rows) + " x " + std::to_string(found.columns), shape);
  if (found.values.size() != rows * columns)
    complain(key, counted(found.values.size(), "number"), shape + " numbers, row by row");
  return std::move(found.values);
}

Eigen::Matrix3d YamlMap::rotation(const std::string& key) const {
  const auto values = matrix(key, 3, 3);
  return nearest_rotation(Eigen::Map<const Eigen::Matrix3d>(values.data()).transpose(), place(key));
}

Eigen::Vector3d YamlMap::vector(const std::string& key) const {
  const auto values = matrix(key).values;
  if (values.size() != 3) complain(key, counted(values.size(), "number"), "3");
  return {values[0], values[1], values[2]};
}

ImageSize YamlMap::checked_size(double columns, double rows, const std::string& key) const {
  for (const double side : {columns, rows}) {
    if (side >= 1 && side <= kLargestImageSide && side == std::floor(side)) continue;
    fail(file_, line(key), "a " + name(key) + " of " + format_exact(columns) + " x " + format_exact(rows),
         "whole numbers of pixels from 1 to " + std::to_string(kLargestImageSide));
  }
  return {static_cast<int>(columns), static_cast<int>(rows)};
}

ImageSize YamlMap::size(const std::string& key) const {
  const auto sides = numbers(key, 2);
  return checked_size(sides[0], sides[1], key);
}

ImageSize YamlMap::size(const std::string& columns, const std::string& rows) const {
  const double width = number(columns), height = number(rows);
  return checked_size(width, height, columns);
}

Eigen::Isometry3d YamlMap::transform(const std::string& key) const {
  auto values = matrix(key).values;
  if (values.size() == 12) values.insert(values.end(), {0, 0, 0, 1});
  if (values.size() != 16) complain(key, counted(values.size(), "number"), "4 x 4 numbers, row by row, or 3 x 4");
  if (values[12] != 0 || values[13] != 0 || values[14] != 0 || values[15] != 1)
    complain(key, "a last row other than 0 0 0 1", name(key) + ": a 4 x 4 matrix, row by row");
  return nearest_transform(values, place(key));
}

Eigen::Isometry3d YamlMap::transform(const std::string& turn, const std::string& shift) const {
  Eigen::Isometry3d transform(rotation(turn));
  transform.translation() = vector(shift);
  return transform;
}

}  // namespace quadedge::data
