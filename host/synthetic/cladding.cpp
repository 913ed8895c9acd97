#include "synthetic/cladding.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "synthetic/dead_leaves.hpp"
#include "synthetic/hash.hpp"

namespace quadedge::synthetic {
namespace {

constexpr double kFilter = 1.5;  // width of the averaging filter [texels]

/// Contribution of a unit to the mean over an interval.
struct Part {
  std::int64_t unit;
  double weight;  // fraction of the interval, 0 to 1
  double place;   // position of the part's middle in the unit, -1 to 1
};

/// Finds the units that an interval [m] overlaps; the rest of the weights up to 1 is joint.
void find_parts(double middle, double width, double pitch, double joint, std::vector<Part>& parts) {
  parts.clear();
  const double low = middle - 0.5 * width, high = middle + 0.5 * width;
  const auto first = static_cast<std::int64_t>(std::floor(low / pitch));
  const auto last = static_cast<std::int64_t>(std::floor(high / pitch));
  for (std::int64_t unit = first; unit <= last; ++unit) {
    const double start = static_cast<double>(unit) * pitch + 0.5 * joint, end = start + pitch - joint;
    const double from = std::max(low, start), to = std::min(high, end);
    if (from >= to) continue;
    parts.push_back({unit, (to - from) / width, (from + to - start - end) / (end - start)});
  }
}

class Cladding : public Painter {
 public:
  Cladding(const CladdingStyle& style, std::uint64_t seed) : style_(style), seed_(seed) {}

  void paint(const TexelSquare& square) const override {
    const double width = kFilter * square.texel;
    std::vector<Part> courses, units;
    for (int y = 0; y < square.side; ++y) {
      find_parts(square.top + y * square.texel, width, style_.unit_height, style_.joint, courses);
      for (int x = 0; x < square.side; ++x) {
        double grey = style_.joint_grey;
        for (const Part& course : courses) {
          const double shift = course.unit % 2 == 0 ? 0.0 : style_.bond * style_.unit_width;
          find_parts(square.left + x * square.texel + shift, width, style_.unit_width, style_.joint, units);
          for (const Part& unit : units)
            grey += course.weight * unit.weight *
                    (tone(course.unit, unit.unit) - style_.bevel * unit.place - style_.joint_grey);
        }
        square.texels[y * square.side + x] = static_cast<float>(grey);
      }
    }
    add_noise(square, style_.noise, style_.noise_size, seed_, style_.grain);
  }

 private:
  double tone(std::int64_t course, std::int64_t unit) const {
    return style_.mean + style_.spread * (2.0 * uniform(combine(combine(seed_, course), unit)) - 1.0);
  }

  CladdingStyle style_;
  std::uint64_t seed_;
};

}  // namespace

std::unique_ptr<const Painter> cladding(const CladdingStyle& style, std::uint64_t seed) {
  return std::make_unique<Cladding>(style, seed);
}

}  // namespace quadedge::synthetic
