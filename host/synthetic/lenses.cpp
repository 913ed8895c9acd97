#include "synthetic/lenses.hpp"

#include <algorithm>

#include "quadedge/synthetic.hpp"

namespace quadedge {
namespace {

struct NamedLens {
  const char* name;
  LensModel model;
  double focal;  ///< factor for the pinhole camera's focal length
  std::vector<double> parameters;
};

/// The wide-angle lenses have a field of view of 150 to 170 degrees at the default image width.
const std::vector<NamedLens>& lenses() {
  static const std::vector<NamedLens> all = {
      {"pinhole", LensModel::radial_tangential, 1, {}},
      {"radtan", LensModel::radial_tangential, 1, {-0.28, 0.074, 2e-4, 2e-5}},
      {"equidistant", LensModel::equidistant, 0.6, {0.0035, 0.0007, -0.0021, 0.0002}},
      {"fov", LensModel::field_of_view, 0.6, {0.92}},
      {"double-sphere", LensModel::double_sphere, 0.5, {-0.2, 0.58}},
      {"omni", LensModel::omnidirectional, 1.3, {1.2, -0.1, 0.05, 1e-4, -1e-4}},
  };
  return all;
}

}  // namespace

const std::vector<std::string>& synthetic_lenses() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const NamedLens& lens : lenses()) list.emplace_back(lens.name);
    return list;
  }();
  return names;
}

namespace synthetic {

Lens make_lens(const std::string& name, double focal) {
  const auto& all = lenses();
  const auto found = std::find_if(all.begin(), all.end(), [&](const NamedLens& lens) { return name == lens.name; });
  Lens lens;
  lens.model = found->model;
  lens.parameters = found->parameters;
  lens.camera.fx = lens.camera.fy = found->focal * focal;
  return lens;
}

}  // namespace synthetic
}  // namespace quadedge
