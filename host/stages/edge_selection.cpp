#include "stages/edge_selection.hpp"

#include <algorithm>

#include "stages/padded_plane.hpp"

namespace quadedge::stages {

EdgeSelection::EdgeSelection(opencl::Context& context, const EdgesConfig& config, const EdgeMaxima& maxima)
    : context_(context),
      budget_(config.budget),
      local_size_(context.is_cpu() ? 1 : 64),
      weighing_group_(std::min<std::size_t>(64, context.limits().group_items)) {
  spacing_.write(context, {0.0F});
  if (budget_ == 0) return;
  tally_.write(context, {0, 0});
  opencl::Defines defines = gradient_defines(config);
  defines.merge(maxima.defines());
  if (maxima.at_pixels) defines["GROUP"] = std::to_string(weighing_group_);
  const cl::Program program = context.program({"edge_detection.cl", "edge_selection.cl"}, defines);
  space_ = {context, program, "edge_selection_spacing"};
  if (maxima.at_pixels) {
    weigh_pixels_ = {context, program, "edge_selection_weigh_pixels"};
    choose_pixels_ = {context, program, "edge_selection_pixels"};
  } else {
    weigh_rows_ = {context, program, "edge_selection_weigh_rows"};
    choose_rows_ = {context, program, "edge_selection_rows"};
  }
}

void EdgeSelection::weigh(const SelectionArguments& arguments, const EdgeMaxima& maxima, cl_int image) {
  const std::size_t samples = (static_cast<std::size_t>(arguments.height) + kSelectionSample - 1) / kSelectionSample;
  if (maxima.at_pixels) {
    weigh_pixels_({samples * weighing_group_, weighing_group_}, arguments, maxima.winners, maxima.flags, image, tally_);
  } else {
    weigh_rows_({samples, local_size_}, arguments, maxima.winners, maxima.counts, image, tally_);
  }
}

void EdgeSelection::choose(const SelectionArguments& arguments, EdgeMaxima& maxima) {
  const auto rows = static_cast<std::size_t>(arguments.height), columns = static_cast<std::size_t>(arguments.width);
  if (maxima.at_pixels) {
    choose_pixels_({rows * columns, local_size_}, arguments, spacing_, maxima.winners, maxima.flags);
  } else {
    choose_rows_({rows, local_size_}, arguments, spacing_, maxima.winners, maxima.counts);
  }
}

void EdgeSelection::run(const SelectionArguments& in_left, const SelectionArguments& in_right, EdgeMaxima& left,
                        EdgeMaxima& right) {
  if (budget_ == 0) return;
  context_.begin_stage("edge_selection");
  weigh(in_left, left, 0);
  weigh(in_right, right, 1);
  space_({1, 1}, budget_, tally_, spacing_);
  choose(in_left, left);
  choose(in_right, right);
}

}  // namespace quadedge::stages
