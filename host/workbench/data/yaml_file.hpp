#pragma once
/// \file yaml_file.hpp  Strict parsing of YAML files. Error messages state file, line and entry.

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <utility>
#include <vector>
#include <yaml-cpp/yaml.h>

#include "data/image_file.hpp"

namespace quadedge::data {

/// Numbers row by row, and their shape where the file states one.
struct YamlMatrix {
  std::vector<double> values;
  std::size_t rows = 0, columns = 0;  ///< 0 x 0: a plain list
};

/// Parses YAML, JSON, or OpenCV's YAML. `file` and `what`, the expected content, are for messages. \throws DataError
/// for text that is none of these, or a map with an entry twice
YAML::Node parse_yaml(const std::string& text, const std::string& file, const std::string& what);

/// A map of a YAML file.
class YamlMap {
 public:
  using Item = std::pair<std::string, YamlMap>;

  /// Reads a file that contains a map. `what`: expected content, for messages ("a Kalibr camera chain"). A first line
  /// "%YAML:1.0", as written by OpenCV, is skipped. \throws DataError for a file that is not YAML, is not a map, or
  /// contains an entry twice
  YamlMap(const std::string& file, const std::string& what);
  /// A map that another reader has made of the file.
  YamlMap(const YAML::Node& node, std::string file, std::string what, std::string prefix = "")
      : node_(node), file_(std::move(file)), what_(std::move(what)), prefix_(std::move(prefix)) {}

  const std::string& file() const { return file_; }
  /// The same map with another expected content.
  YamlMap as(const std::string& what) const;
  std::vector<std::string> keys() const;
  bool has(const std::string& key) const { return node_[key].IsDefined(); }
  bool holds_map(const std::string& key) const { return node_[key].IsMap(); }
  /// Line number of the entry, from 1.
  int line(const std::string& key) const { return node_[key].Mark().line + 1; }
  /// "FILE:LINE (NAME)", for messages about an entry.
  std::string place(const std::string& key) const {
    return file_ + ":" + std::to_string(line(key)) + " (" + name(key) + ")";
  }
  /// Full name of the entry, "cam0.intrinsics".
  std::string name(const std::string& key) const { return prefix_ + key; }

  // All of these \throw DataError if an entry is missing or of another kind.
  YamlMap map(const std::string& key) const;
  /// The maps of a list, each with its position, or with what stands before it in [name, map].
  std::vector<Item> items(const std::string& key) const;
  std::string word(const std::string& key) const;
  double number(const std::string& key) const;
  /// The number, or `otherwise` if there is no such entry.
  double number_or(const std::string& key, double otherwise) const { return has(key) ? number(key) : otherwise; }
  /// Of a list, which has `count` of them if that is given.
  std::vector<double> numbers(const std::string& key, std::optional<std::size_t> count = std::nullopt) const;
  /// The numbers of several entries, whose names begin with `prefix`.
  std::vector<double> numbers_of(const std::vector<const char*>& names, const std::string& prefix = "") const;
  /// A list, a list of rows, OpenCV's or ROS's {rows, cols, data}, or numbers in a line.
  YamlMatrix matrix(const std::string& key) const;
  /// The same, of this shape or a plain list of as many numbers.
  std::vector<double> matrix(const std::string& key, std::size_t rows, std::size_t columns) const;
  /// The nearest rotation to a 3 x 3 matrix. \throws DataError for one that is not orthonormal
  Eigen::Matrix3d rotation(const std::string& key) const;
  Eigen::Vector3d vector(const std::string& key) const;
  /// "[columns, rows]"
  ImageSize size(const std::string& key) const;
  /// Columns and rows in separate entries.
  ImageSize size(const std::string& columns, const std::string& rows) const;
  /// A 4 x 4 matrix, or its first three rows. Its 3 x 3 part is replaced by the nearest rotation.
  Eigen::Isometry3d transform(const std::string& key) const;
  /// A rotation matrix and a translation in separate entries.
  Eigen::Isometry3d transform(const std::string& turn, const std::string& shift) const;

  /// \throws DataError about an existing entry.
  [[noreturn]] void complain(const std::string& key, const std::string& found, const std::string& expected) const;

 private:
  YAML::Node entry(const std::string& key) const;
  void add_numbers(const YAML::Node& list, const std::string& expected, std::vector<double>& values) const;
  ImageSize checked_size(double columns, double rows, const std::string& key) const;

  YAML::Node node_;
  std::string file_, what_, prefix_;
};

}  // namespace quadedge::data
