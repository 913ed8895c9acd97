#include "report/append_file.hpp"

#include <cerrno>
#include <cstring>

#include "quadedge/error.hpp"

namespace quadedge::report {

AppendFile::AppendFile(std::string path) : path_(std::move(path)), stream_(std::fopen(path_.c_str(), "wb")) {
  if (stream_ == nullptr) fail("opened for writing");
}

AppendFile::~AppendFile() {
  if (stream_ != nullptr) std::fclose(stream_);
}

void AppendFile::append(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stream_) != text.size() || std::fflush(stream_) != 0) fail("written");
}

void AppendFile::fail(const char* what) const {
  throw DataError(path_ + ": cannot be " + what + ": " + std::strerror(errno));
}

}  // namespace quadedge::report
