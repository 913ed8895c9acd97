#include "report/match_drawings.hpp"

#include <cctype>
#include <filesystem>
#include <map>

#include "quadedge/error.hpp"
#include "report/canvas.hpp"
#include "report/draw_matches.hpp"

namespace quadedge::report {
namespace {

/// The name with everything but letters, digits, "-", "_" and "." replaced.
std::string file_name_of(const std::string& name) {
  std::string result;
  for (const char c : name) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
    result += plain ? c : '_';
  }
  return result;
}

}  // namespace

std::vector<WrittenDrawing> write_match_drawings(const std::string& folder,
                                                 const std::vector<evaluation::MatchingResult>& results,
                                                 const evaluation::MatchingTolerance& tolerance) {
  std::vector<WrittenDrawing> written;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw DataError(folder + ": the folder cannot be made: " + error.message());
  std::map<std::string, int> used;
  for (const auto& result : results) {
    if (!result.drawn) continue;
    std::string name = file_name_of(result.name);
    if (const int number = ++used[name]; number > 1) name += "_" + std::to_string(number);
    for (const auto& drawing : draw_matches(*result.drawn, result.name, tolerance.position, tolerance.wrong)) {
      const std::string file = (std::filesystem::absolute(folder) / (name + "_" + drawing.file)).string();
      write_png(file, drawing.picture);
      written.push_back({result.name, file, drawing.caption});
    }
  }
  return written;
}

}  // namespace quadedge::report
