#include "data/user_folder.hpp"

#include <cstdlib>

namespace quadedge::data {
namespace {

std::string user_folder(const char* variable, const char* below_home) {
  const char* base = std::getenv(variable);
  if (base != nullptr && base[0] == '/')
    return std::string(base) + "/quadedge";  // the specification requires relative paths to be ignored
  const char* home = std::getenv("HOME");
  if (home != nullptr && home[0] != '\0') return std::string(home) + below_home + "/quadedge";
  return {};
}

}  // namespace

std::string configuration_folder() { return user_folder("XDG_CONFIG_HOME", "/.config"); }

std::string cache_folder() { return user_folder("XDG_CACHE_HOME", "/.cache"); }

}  // namespace quadedge::data
