#include "stages/temporal_match.hpp"

#include <limits>

#include "opencl/variants.hpp"
#include "quadedge/filters.hpp"
#include "stages/quad_rows.hpp"

namespace quadedge::stages {
TemporalMatch::TemporalMatch(opencl::Context& context, const TemporalConfig& config,
                             const std::map<std::string, std::string>& variants)
    : context_(context), config_(config), variants_(variants) {
  const auto& variant = opencl::choose_variant("temporal_match", context, variants);
  fused_ = variant.form != opencl::Form::lists;
  local_size_ = static_cast<std::size_t>(variant.local_size);
  items_per_row_ = variant.form == opencl::Form::groups ? local_size_ : 1;
  if (fused_) kernel_ = {context, variant.program(context), "temporal_match"};
}

void TemporalMatch::prepare_tap() {
  if (tap_ || !fused_) return;
  opencl::Defines defines = {{"TAP", "1"}};
  for (const auto& [name, filter] : {std::pair("ORIENTATION_ORDER", TemporalFilter::orientation),
                                     {"NCC_ORDER", TemporalFilter::ncc},
                                     {"NEARLY_BEST_NCC_ORDER", TemporalFilter::nearly_best_ncc},
                                     {"AGREEMENT_ORDER", TemporalFilter::agreement}}) {
    defines[name] = std::to_string(order_of(filter));
  }
  tap_.emplace();
  tap_->scan = Scan(context_, variants_);
  const auto& variant = opencl::choose_variant("temporal_match", context_, variants_);
  tap_->kernel = {context_, variant.program(context_, defines), "temporal_match"};
}

/// Sorts what the kernel wrote of both sides into lists of their own.
void TemporalMatch::read_tapped(std::size_t rows, TappedMatch& tapped) const {
  const auto first = tap_->first.read(2 * rows + 1);
  const auto seen = tap_->seen.read(kTappedInts * static_cast<std::size_t>(first.back()));
  tapped = {};
  for (auto* side : {&tapped.left, &tapped.right}) side->first.assign(1, 0);
  for (std::size_t list = 0; list < 2 * rows; ++list) {
    JudgedCandidates& side = list % 2 == 0 ? tapped.left : tapped.right;
    for (auto c = static_cast<std::size_t>(first[list]); c < static_cast<std::size_t>(first[list + 1]); ++c) {
      const cl_int* values = seen.data() + kTappedInts * c;
      side.target.push_back(values[0]);
      side.state.push_back(static_cast<std::uint8_t>(values[1]));
      side.ncc.push_back(from_bits(values[2]));
      side.sift.push_back(from_bits(values[3]));
    }
    side.first.push_back(static_cast<std::int32_t>(side.target.size()));
  }
}

std::optional<AliveRows> TemporalMatch::read_quads(std::size_t rows, int step, const StereoEdges& edges,
                                                   TemporalMatches& matches) {
  matches.clear();
  std::optional<AliveRows> alive = AliveRows();
  read_back_.read(context_, result_, kQuadRowInts * rows, [&](const cl_int* values) {
    for (std::size_t row = 0; row < rows; ++row, values += kQuadRowInts) {
      if ((values[3] & kRowOverflow) != 0) {
        alive.reset();
        break;
      }
      alive->left += (values[3] & kLeftAlive) != 0 ? 1 : 0;
      alive->right += (values[3] & kRightAlive) != 0 ? 1 : 0;
      append_row(values, static_cast<std::int32_t>(row) * step, edges, matches);
    }
  });
  return alive;
}

std::optional<AliveRows> TemporalMatch::run(const DevicePositions& predicted, const TemporalSearch& search,
                                            const DeviceStereoEdges& base, const DeviceStereoEdges& current,
                                            const DevicePointIndex& left, const DevicePointIndex& right,
                                            const StereoEdges& edges, TemporalMatches& matches, TappedMatch* tapped) {
  context_.begin_stage("temporal_match");
  const PositionsView left_predicted = predicted.list(0), right_predicted = predicted.list(1);
  const int count = (left_predicted.at.count + search.step - 1) / search.step;
  const auto rows = static_cast<std::size_t>(count);
  result_.ensure(context_, kQuadRowInts * rows);
  const FilterLimits limits = temporal_limits(config_, search);
  const TemporalMatchArguments arguments{count,
                                         search.step,
                                         left_predicted.at,
                                         right_predicted.at,
                                         left.layout(),
                                         right.layout(),
                                         current.positions(Side::left).at,
                                         search.radius,
                                         static_cast<float>(config_.orientation_rad()),
                                         limits.ncc_min,
                                         limits.ncc_nearly_best,
                                         quad_choice(config_, search)};
  const auto launch = [&](const auto& kernel, auto&&... of_tap) {
    kernel({rows * items_per_row_, local_size_}, arguments, left_predicted.packed, left.points, left.cells,
           right.points, right.cells, base.left_patches, base.left_index, base.right_patches, current.left_patches,
           current.left_index, current.right_patches, current.packed, result_, of_tap...);
  };
  if (tapped == nullptr) {
    launch(kernel_);
  } else {
    prepare_tap();
    TapForm& tap = *tap_;
    tap.counts.ensure(context_, 2 * rows);
    tap.first.ensure(context_, 2 * rows + 1);
    tap.seen.ensure(context_, 1);
    const auto launch_tap = [&](cl_int capacity) {
      launch(tap.kernel, tap.first, capacity, tap.counts, tap.seen, base.left_sift, base.right_sift, current.left_sift,
             current.right_sift);
    };
    launch_tap(0);
    tap.scan.run(tap.counts, 2 * count, std::numeric_limits<cl_int>::max(), tap.first, tap.total);
    const cl_int size = tap.total.read(2)[0];
    tap.seen.ensure(context_, kTappedInts * static_cast<std::size_t>(size));
    if (size > 0) launch_tap(size);
    read_tapped(rows, *tapped);
  }
  return read_quads(rows, search.step, edges, matches);
}

}  // namespace quadedge::stages
