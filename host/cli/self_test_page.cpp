/// \file self_test_page.cpp  `quadedge generate self-test`: host/frontend/self_test.rows.
#include "cli/generated_pages.hpp"
#include "frontend/self_test_record.hpp"
#include "quadedge/synthetic.hpp"

namespace quadedge::cli {

std::string self_test_page() {
  SyntheticOptions scene;
  scene.width = 113;  // no multiple of any work-group
  scene.height = 71;
  scene.focal = 0.575 * scene.width;
  scene.baseline = 0.15;
  scene.frames = 2;
  const SyntheticSequence rendered(scene);
  frontend::SelfTestRecord record;
  record.sequence.rig = rendered.rig();
  record.sequence.max_disparity = rendered.rig().max_disparity;
  for (int i = 0; i < 2; ++i) {
    record.sequence.left[i] = rendered.render(i, Side::left).image;
    record.sequence.right[i] = rendered.render(i, Side::right).image;
  }
  Device reference("reference");
  record.stages = frontend::observe_stages(record.sequence, reference, {});
  return to_text(record);
}

}  // namespace quadedge::cli
