#pragma once
/// \file append_file.hpp  A text file that is written row by row; finished rows survive a crash.

#include <cstdio>
#include <string>

namespace quadedge::report {

/// Truncates the file on opening and flushes after each append, so that a run that dies keeps all finished rows.
class AppendFile {
 public:
  /// \throws DataError with path and reason when the file cannot be opened.
  explicit AppendFile(std::string path);
  ~AppendFile();
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  /// \throws DataError with path and reason (full disk) when the text cannot be written.
  void append(const std::string& text);

 private:
  [[noreturn]] void fail(const char* what) const;
  std::string path_;
  std::FILE* stream_ = nullptr;
};

}  // namespace quadedge::report
