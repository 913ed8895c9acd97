#include "cli/standard_streams.hpp"

#include <cerrno>
#include <fcntl.h>
#include <unistd.h>

namespace quadedge::cli {

void occupy_standard_streams() {
  // In this order: open() takes the lowest number that is free. What is open for reading alone cannot be written.
  constexpr struct {
    int stream, mode;
  } kStreams[] = {{STDIN_FILENO, O_RDONLY}, {STDOUT_FILENO, O_RDONLY}, {STDERR_FILENO, O_WRONLY}};
  for (const auto& [stream, mode] : kStreams) {
    if (fcntl(stream, F_GETFD) < 0 && errno == EBADF) open("/dev/null", mode);
  }
}

}  // namespace quadedge::cli
