#pragma once
/// \file self_test_now.hpp  The data of the self-test as the renderer and the plain C++ reference make it now.

#include <algorithm>
#include <type_traits>
#include <variant>

#include "edges/self_test_data.hpp"
#include "quadedge/synthetic.hpp"

inline quadedge::frontend::SmallSequence rendered_for_self_test() {
  using namespace quadedge;
  SyntheticOptions scene;
  scene.width = 113;  // no multiple of any work-group
  scene.height = 71;
  scene.focal = 0.575 * scene.width;
  scene.baseline = 0.15;
  scene.frames = 2;
  const SyntheticSequence rendered(scene);
  frontend::SmallSequence sequence;
  sequence.rig = rendered.rig();
  sequence.max_disparity = rendered.rig().max_disparity;
  for (int i = 0; i < 2; ++i) {
    sequence.left[i] = rendered.render(i, Side::left).image;
    sequence.right[i] = rendered.render(i, Side::right).image;
  }
  return sequence;
}

/// The numbers in which the paper's preset differs from the defaults.
inline std::vector<std::pair<std::string, double>> values_of_paper() {
  using namespace quadedge;
  const auto number = [](const Constant& constant, Config config) {
    return std::visit(
        [](const auto* value) -> double {
          if constexpr (std::is_arithmetic_v<std::remove_pointer_t<decltype(value)>>)
            return static_cast<double>(*value);
          return 0;
        },
        constant.field(config));
  };
  std::vector<std::pair<std::string, double>> values;
  for (const Constant& constant : constants()) {
    const double value = number(constant, read_preset("paper"));
    if (value != number(constant, {})) values.emplace_back(constant.key(), value);
  }
  return values;
}

inline quadedge::frontend::SelfTestData self_test_now() {
  using namespace quadedge;
  frontend::SelfTestData data;
  data.sequence = rendered_for_self_test();
  data.paper = values_of_paper();
  Device reference("reference");
  data.expected = frontend::observe_stages(data.sequence, reference, {});
  data.paper_expected = frontend::observe_paper_stages(data.sequence, reference, data.paper_config());
  for (auto* stages : {&data.expected, &data.paper_expected})
    for (auto& stage : *stages) std::sort(stage.rows.begin(), stage.rows.end());
  return data;
}
