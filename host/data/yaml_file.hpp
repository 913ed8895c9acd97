#pragma once
/// \file yaml_file.hpp  Strict reading of YAML files: every complaint names the file, the line and the entry.

#include <Eigen/Geometry>
#include <string>
#include <vector>
#include <yaml-cpp/yaml.h>

#include "data/image_file.hpp"

namespace quadedge::data {

/// A map of a YAML file.
class YamlMap {
 public:
  /// Reads a file that holds a map. `what` it should be, for messages: "a Kalibr camera chain". A first line
  /// "%YAML:1.0", as OpenCV writes it, is skipped. \throws DataError for what is no YAML, no map, or has an entry
  /// twice.
  YamlMap(const std::string& file, const std::string& what);

  const std::string& file() const { return file_; }
  /// The same map, expected to be something else from now on.
  YamlMap as(const std::string& what) const;
  std::vector<std::string> keys() const;
  bool has(const std::string& key) const { return node_[key].IsDefined(); }
  /// Of the entry in the file, from 1.
  int line(const std::string& key) const { return node_[key].Mark().line + 1; }
  /// The entry's name from the file's top, "cam0.intrinsics".
  std::string name(const std::string& key) const { return prefix_ + key; }

  // All of them \throw DataError for an entry that is missing or of another kind.
  YamlMap map(const std::string& key) const;
  std::string word(const std::string& key) const;
  std::vector<double> numbers(const std::string& key) const;
  std::vector<double> numbers(const std::string& key, std::size_t count) const;
  /// "[columns, rows]"
  ImageSize size(const std::string& key) const;
  /// Columns and rows in entries of their own.
  ImageSize size(const std::string& columns, const std::string& rows) const;
  /// 4 x 4: sixteen numbers in one list, or four lists of four. The rotation nearest to its 3 x 3 part.
  Eigen::Isometry3d transform(const std::string& key) const;

  /// \throws DataError about an entry that is there.
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
