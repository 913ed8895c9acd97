#pragma once
/// \file yaml_file.hpp  Strict parsing of YAML files. Error messages state file, line and entry.

#include <Eigen/Geometry>
#include <string>
#include <vector>
#include <yaml-cpp/yaml.h>

#include "data/image_file.hpp"

namespace quadedge::data {

/// A map of a YAML file.
class YamlMap {
 public:
  /// Reads a file that contains a map. `what`: expected content, for messages ("a Kalibr camera chain"). A first line
  /// "%YAML:1.0", as written by OpenCV, is skipped. \throws DataError for a file that is not YAML, is not a map, or
  /// contains an entry twice
  YamlMap(const std::string& file, const std::string& what);

  const std::string& file() const { return file_; }
  /// The same map with another expected content.
  YamlMap as(const std::string& what) const;
  std::vector<std::string> keys() const;
  bool has(const std::string& key) const { return node_[key].IsDefined(); }
  /// Line number of the entry, from 1.
  int line(const std::string& key) const { return node_[key].Mark().line + 1; }
  /// Full name of the entry, "cam0.intrinsics".
  std::string name(const std::string& key) const { return prefix_ + key; }

  // All of these \throw DataError if an entry is missing or of another kind.
  YamlMap map(const std::string& key) const;
  std::string word(const std::string& key) const;
  std::vector<double> numbers(const std::string& key) const;
  std::vector<double> numbers(const std::string& key, std::size_t count) const;
  /// "[columns, rows]"
  ImageSize size(const std::string& key) const;
  /// Columns and rows in separate entries.
  ImageSize size(const std::string& columns, const std::string& rows) const;
  /// A 4 x 4 matrix: sixteen numbers in one list, or four lists of four. Its 3 x 3 part is replaced by the nearest
  /// rotation.
  Eigen::Isometry3d transform(const std::string& key) const;

  /// \throws DataError about an existing entry.
  [[noreturn]] void complain(const std::string& key, const std::string& found, const std::string& expected) const;

 private:
  YamlMap(const YAML::Node& node, std::string file, std::string what, std::string prefix)
      : node_(node), file_(std::move(file)), what_(std::move(what)), prefix_(std::move(prefix)) {}
  YAML::Node entry(const std::string& key) const;
  void add_numbers(const YAML::Node& list, const std::string& expected, std::vector<double>& values) const;
  ImageSize checked_size(double columns, double rows, const std::string& key) const;

  YAML::Node node_;
  std::string file_, what_, prefix_;
};

}  // namespace quadedge::data
