/// \file command_evaluate_matching.cpp  quadedge evaluate matching: what every filter keeps and loses.
#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <string>

#include "cli/command.hpp"
#include "cli/console.hpp"
#include "cli/frame_source.hpp"
#include "cli/method_options.hpp"
#include "cli/processes.hpp"
#include "cli/source_options.hpp"
#include "data/atomic_file.hpp"
#include "evaluation/matching_observer.hpp"
#include "evaluation/matching_result.hpp"
#include "quadedge/error.hpp"
#include "quadedge/tap.hpp"
#include "report/drawing.hpp"
#include "report/matching_json.hpp"
#include "report/output_folder.hpp"

namespace quadedge::cli {
namespace {

using evaluation::FilterCounts;
using evaluation::PooledRow;

std::string decimal(double value, int decimals) {
  return dashed(("%." + std::to_string(decimals) + "f").c_str(), value);
}

/// A share in percent, or a dash where it does not exist.
std::string percent(double share, int decimals = 2) { return decimal(100 * share, decimals); }

/// A share that may be far below one percent.
std::string fine_percent(double share) { return percent(share, share < 0.0005 ? 4 : 2); }

void print_counts(const FilterCounts& counts, const evaluation::FilterSpread& spread) {
  std::printf(" | %7s +-%5s %7s +-%5s %8s %9s %9s %6s", percent(counts.recall()).c_str(),
              percent(spread.recall, 1).c_str(), fine_percent(counts.precision()).c_str(),
              percent(spread.precision, 1).c_str(), fine_percent(counts.precision_per_edge()).c_str(),
              decimal(counts.ambiguity_mean(), 3).c_str(), decimal(counts.ambiguity_of_pool(), 3).c_str(),
              decimal(counts.ambiguity_max(), 0).c_str());
}

void print_filters(const char* title, const std::vector<PooledRow>& rows) {
  if (rows.empty()) return;
  std::printf("\n%s\n%-29s | paired: %" PRId64 " edges%-*s | all: %" PRId64 " edges\n", title, "",
              rows[0].row.paired.pool, 44, "", rows[0].row.all.pool);
  std::printf("%-29s", "order filter");
  for (int pool = 0; pool < 2; ++pool)
    std::printf(" | %-15s %-15s %8s %9s %9s %6s", " recall %", "precision %", "per edge", "ambiguity", "of pool",
                "max");
  std::printf("\n");
  for (const auto& pooled : rows) {
    std::printf("%2d %-26s", pooled.row.order, pooled.row.filter.c_str());
    print_counts(pooled.row.paired, pooled.paired_std);
    print_counts(pooled.row.all, pooled.all_std);
    std::printf("\n");
  }
}

void print_constraints(const evaluation::MatchingSummary& summary) {
  const auto& table = summary.constraints;
  if (table[0].counts.pairs == 0) return;
  std::printf("\nTable 3: pairs of quads after each constraint, %" PRId64 " pairs drawn\n%-29s  %-15s  %-15s\n",
              table[0].counts.pairs, "order constraint", "  recall %", "precision %");
  for (std::size_t order = 0; order < table.size(); ++order) {
    const auto& row = table[order];
    std::printf(
        "%2zu %-26s  %7s +-%5s  %7s +-%5s\n", order, evaluation::kConstraintNames[order],
        percent(static_cast<double>(row.counts.veridical) / static_cast<double>(table[0].counts.veridical)).c_str(),
        percent(row.recall_std, 1).c_str(),
        percent(static_cast<double>(row.counts.veridical) / static_cast<double>(row.counts.pairs)).c_str(),
        percent(row.precision_std, 1).c_str());
  }
}

void print_quads(const char* pool, const evaluation::PooledQuads& quads) {
  std::printf("quads, %-7s recall %s +- %s %%, precision %s +- %s %% (%" PRId64 " edges, %" PRId64 " quads)\n", pool,
              percent(quads.counts.recall()).c_str(), percent(quads.std.recall, 1).c_str(),
              percent(quads.counts.precision()).c_str(), percent(quads.std.precision, 1).c_str(), quads.counts.pool,
              quads.counts.candidates);
}

const PooledRow* find(const std::vector<PooledRow>& rows, int order) {
  for (const auto& row : rows) {
    if (row.row.order == order) return &row;
  }
  return nullptr;
}

void print_sweep_row(const std::vector<PooledRow>& rows, int order) {
  const PooledRow* row = find(rows, order);
  if (row == nullptr) return;
  const FilterCounts &paired = row->row.paired, &all = row->row.all;
  std::printf(" | %7s %7s %8s %7s %7s", percent(paired.recall()).c_str(), percent(paired.precision()).c_str(),
              decimal(paired.ambiguity_mean(), 3).c_str(), percent(all.recall()).c_str(),
              percent(all.precision()).c_str());
}

void print_sweep_title(const char* table, const std::vector<PooledRow>& rows, int order) {
  const PooledRow* row = find(rows, order);
  if (row != nullptr)
    std::printf(" | %-40s", (std::string(table) + " " + std::to_string(order) + " " + row->row.filter).c_str());
}

/// Calls `print` for the chosen rows of all three tables.
template <class Print>
void for_rows(const evaluation::MatchingSummary& summary, const std::vector<int>& stereo_orders,
              const std::vector<int>& temporal_orders, const Print& print) {
  for (const int order : stereo_orders) print("stereo", summary.stereo, order);
  for (const int order : temporal_orders) {
    print("left", summary.temporal_left, order);
    print("right", summary.temporal_right, order);
  }
}

/// Tables 1 to 3, the quads and the disparity errors of one or several results.
void print_matching(const std::string& title, const evaluation::MatchingSummary& summary) {
  std::printf("\n=== %s: %d stereo frame%s ===\n", title.c_str(), summary.frames, summary.frames == 1 ? "" : "s");
  const auto& census = summary.census;
  std::printf("left edges %" PRId64 ": no statement about %" PRId64 ", along their epipolar line %" PRId64
              ", occluded %" PRId64 ", on depth steps %" PRId64 "\n",
              census.edges, census.no_statement, census.along_line, census.occluded, census.contour);
  print_filters("Table 1: stereo", summary.stereo);
  std::printf("final stereo edges: ");
  for (std::size_t kind = 0; kind < summary.classes.size(); ++kind) {
    std::printf("%s%" PRId64 " %s", kind == 0 ? "" : ", ", summary.classes[kind], evaluation::kMatchClassNames[kind]);
  }
  std::printf("\n");
  std::printf("disparity error: median %s px, p90 %s px, bias %s px; across the edge: median %s px, p90 %s px\n",
              decimal(summary.disparity_median, 4).c_str(), decimal(summary.disparity_p90, 4).c_str(),
              decimal(summary.disparity_bias, 4).c_str(), decimal(summary.across_median, 4).c_str(),
              decimal(summary.across_p90, 4).c_str());
  print_filters("Table 2: in time, left images", summary.temporal_left);
  print_filters("Table 2: in time, right images", summary.temporal_right);
  if (summary.temporal_frames > 0) {
    std::printf("\n");
    print_quads("paired:", summary.quads_paired);
    print_quads("all:", summary.quads_all);
    std::printf("quads, paired: ambiguity %s +- %s (further matches per quad)\n",
                decimal(summary.quads_paired.ambiguity_mean, 3).c_str(),
                decimal(summary.quads_paired.std.ambiguity, 3).c_str());
  }
  print_constraints(summary);
}

/// Heading of the lines that print_sweep_line prints; `filters`: the rows of the table that are shown.
void print_sweep_heading(const std::string& key, const evaluation::MatchingSummary& summary,
                         const std::vector<int>& stereo_orders, const std::vector<int>& temporal_orders) {
  std::printf("%12s", "");
  for_rows(summary, stereo_orders, temporal_orders, print_sweep_title);
  std::printf("\n%12s", key.substr(key.find('.') + 1).substr(0, 12).c_str());
  for_rows(summary, stereo_orders, temporal_orders, [](const char*, const std::vector<PooledRow>& rows, int order) {
    if (find(rows, order) != nullptr)
      std::printf(" | %7s %7s %8s %7s %7s", "rec", "prec", "ambig", "rec.all", "prec.all");
  });
  std::printf("  quads rec  prec  prec.all  disp.med\n");
}

/// Recall, precision and ambiguity of some rows for one value of a threshold.
void print_sweep_line(double value, const evaluation::MatchingSummary& summary, const std::vector<int>& stereo_orders,
                      const std::vector<int>& temporal_orders) {
  std::printf("%12g", value);
  for_rows(summary, stereo_orders, temporal_orders,
           [](const char*, const std::vector<PooledRow>& rows, int order) { print_sweep_row(rows, order); });
  const FilterCounts& quads = summary.quads_paired.counts;
  std::printf("  %9s %5s %9s %9s\n", percent(quads.recall()).c_str(), percent(quads.precision()).c_str(),
              percent(summary.quads_all.counts.precision()).c_str(), decimal(summary.disparity_median, 4).c_str());
  std::fflush(stdout);
}

constexpr int kRenderedFrames = 10;  // of a built-in scene, unless --frames says otherwise

/// What `--sweep SECTION.FIELD=FIRST:LAST:STEP` asks for.
struct Sweep {
  std::string key;
  std::vector<double> values;        ///< FIRST, FIRST + STEP, ... up to LAST
  std::vector<int> stereo_orders;    ///< rows of Table 1 that the constant affects, and the last one
  std::vector<int> temporal_orders;  ///< rows of Table 2
};

/// Which filter a constant belongs to; the beginning of its name decides.
template <class Filter>
struct Belongs {
  const char* key;
  Filter filter;
};
constexpr Belongs<StereoFilter> kStereo[] = {{"stereo.epipolar_distance", StereoFilter::epipolar_distance},
                                             {"stereo.min_depth", StereoFilter::disparity},
                                             {"stereo.max_disparity", StereoFilter::disparity},
                                             {"stereo.orientation", StereoFilter::orientation},
                                             {"stereo.sift_max", StereoFilter::sift},
                                             {"stereo.ncc_min", StereoFilter::ncc},
                                             {"stereo.ncc_nearly_best", StereoFilter::nearly_best_ncc},
                                             {"stereo.sift_nearly_best", StereoFilter::nearly_best_sift},
                                             {"stereo.shift", StereoFilter::refinement},
                                             {"stereo.refine_", StereoFilter::refinement},
                                             {"stereo.cluster", StereoFilter::refinement},
                                             {"stereo.refined_ncc_min", StereoFilter::similarity},
                                             {"stereo.refined_ncc_min", StereoFilter::relaxation},
                                             {"stereo.relaxation", StereoFilter::relaxation},
                                             {"stereo.support_weight", StereoFilter::relaxation}};
constexpr Belongs<TemporalFilter> kTemporal[] = {{"temporal.radius", TemporalFilter::displacement},
                                                 {"temporal.orientation", TemporalFilter::orientation},
                                                 {"temporal.ncc_min", TemporalFilter::ncc},
                                                 {"temporal.sift_max", TemporalFilter::sift},
                                                 {"temporal.ncc_nearly_best", TemporalFilter::nearly_best_ncc},
                                                 {"temporal.sift_nearly_best", TemporalFilter::nearly_best_sift}};

/// Rows of the filters that a constant belongs to, then the last row.
template <class Filter, std::size_t Size>
std::vector<int> rows_of(const std::string& key, const Belongs<Filter> (&table)[Size]) {
  std::vector<int> rows;
  for (const auto& entry : table) {
    if (key.rfind(entry.key, 0) == 0) rows.push_back(order_of(entry.filter));
  }
  rows.push_back(order_of(Filter::best));
  return rows;
}

/// The configuration with one constant changed. \throws UsageError for a value out of its range.
Config with_value(Config config, const std::string& key, double value) {
  const auto& all = constants();
  const auto constant =
      std::find_if(all.begin(), all.end(), [&](const Constant& candidate) { return candidate.key() == key; });
  const ConfigField field = constant == all.end() ? ConfigField(static_cast<bool*>(nullptr)) : constant->field(config);
  if (auto* const* real = std::get_if<double*>(&field)) {
    **real = value;
  } else if (auto* const* whole = std::get_if<int*>(&field)) {
    **whole = static_cast<int>(std::lround(value));
  } else {
    throw UsageError("--sweep: no numeric constant '" + key + "'; --help-all lists all constants");
  }
  check_config(config);
  return config;
}

/// \throws UsageError for malformed text, an unknown key, or a constant that is not a number.
Sweep parse_sweep(const std::string& text) {
  const auto equals = text.find('=');
  double first = 0, last = 0, step = 0;
  int length = 0;
  if (equals == std::string::npos ||
      std::sscanf(text.c_str() + equals, "=%lf:%lf:%lf%n", &first, &last, &step, &length) != 3 ||
      equals + static_cast<std::size_t>(length) != text.size() || !(step > 0) || !(last >= first) ||
      !((last - first) / step < 1000)) {
    throw UsageError("--sweep " + text +
                     ": expected SECTION.FIELD=FIRST:LAST:STEP, for example stereo.ncc_min=0.4:0.9:0.05");
  }
  Sweep sweep;
  sweep.key = text.substr(0, equals);
  const int count = static_cast<int>((last - first) / step + 1e-9) + 1;
  for (int i = 0; i < count; ++i) sweep.values.push_back(first + i * step);
  sweep.stereo_orders = rows_of(sweep.key, kStereo);
  sweep.temporal_orders = rows_of(sweep.key, kTemporal);
  with_value({}, sweep.key, first);
  return sweep;
}

class EvaluateMatchingCommand : public Command {
 public:
  EvaluateMatchingCommand()
      : Command("evaluate matching", "recall, precision and ambiguity after every filter (Tables 1 to 3)",
                "  quadedge evaluate matching two_view_training/terrace_2s --html terrace.html --json terrace.json\n"
                "  quadedge evaluate matching room --frames 5 --sweep stereo.ncc_min=0.4:0.9:0.05") {}
  void declare(Options& options) override {
    options.positionals("PATH", paths_,
                        "stereo pairs with disparities, sequences with depth (`quadedge synth`), folders of these, or "
                        "a built-in scene: "
                        "room, cables, facade");
    options.number("--frames", frames_,
                   "evaluate only the first N frames of each sequence; 0: all, 10 of a built-in scene");
    declare_view(options, scene_, size_);
    options.number("--scene-seed", scene_.seed, "seed of the built-in scenes");
    options.number("--tolerance", tolerance_.position,
                   "maximum distance of a veridical match from the true position [px]");
    options.text("--sweep", sweep_, "print only the trade-off of one constant: SECTION.FIELD=FIRST:LAST:STEP", "RANGE");
    options.output("--json", json_, "also write the tables to a file");
    options.output(
        "--html", html_,
        "also make an HTML page with tables, plots and drawings; its data is written beside it, as by --json and "
        "--draw");
    options.text("--draw", draw_, "also draw the last frame of each pair or sequence as PNG, in a folder", "DIR");
    options.flag("--force", force_, "overwrite existing files");
    options.flag("--quiet", quiet_, "hide progress");
    method_.declare(options);
  }

  int run() override {
    if (frames_ < 0) throw UsageError("--frames " + std::to_string(frames_) + ": expected 0 or more");
    if (!(tolerance_.position > 0 && tolerance_.position <= 100))
      throw UsageError("--tolerance: expected more than 0 and at most 100 px");
    if (!sweep_.empty() && !(json_.empty() && html_.empty() && draw_.empty())) {
      throw UsageError("--sweep excludes --json, --html and --draw");
    }
    report::check_output_file(html_, force_);
    place_data_of_page();
    report::refuse_shared_files({html_, json_}, {});
    report::check_output_file(json_, force_);
    report::refuse_full_folder(draw_, force_);
    const Config config = method_.config();
    open_sources();
    Device device = method_.open_device();
    if (!sweep_.empty()) return run_sweep(config, device);
    const auto results = evaluate(config, device, true);
    if (results.size() > 1) {
      for (const auto& result : results) print_matching(result.name, evaluation::summarise({result}));
    }
    print_matching(results.size() > 1 ? "all" : results[0].name, evaluation::summarise(results));
    report::MatchingFacts facts{command_line(), paths_, device.info(), config, tolerance_, {}};
    if (!draw_.empty()) facts.drawings = report::write_match_drawings(draw_, results, tolerance_);
    if (!json_.empty()) data::write_atomically(json_, report::matching_json(results, facts));
    return html_.empty() ? 0 : make_page({json_, "--output", html_, "--quiet"}, Interruption());
  }

 private:
  /// A page is made from files; by default they are beside it.
  void place_data_of_page() {
    if (html_.empty()) return;
    const std::filesystem::path page = html_;
    if (json_.empty()) json_ = std::filesystem::path(page).replace_extension(".json").string();
    if (draw_.empty()) draw_ = (page.parent_path() / (page.stem().string() + "_drawings")).string();
    if (json_ == html_)
      throw UsageError("--html " + html_ + ": this file will hold the figures; expected a name ending in .html");
  }

  void open_sources() {
    for (const auto& path : paths_) {
      if (is_scene(path)) {
        SyntheticOptions scene = scene_;
        scene.scene = path;
        scene.frames = frames_ > 0 ? frames_ : kRenderedFrames;
        set_size(scene, size_);
        sources_.push_back(evaluation::make_rendered_source(scene));
        continue;
      }
      std::vector<std::string> skipped;
      for (const auto& dataset : evaluation::find_true_datasets(path, skipped)) {
        sources_.push_back(evaluation::make_recorded_source(dataset));
      }
      for (const auto& reason : skipped) note("warning: skipped: " + reason);
    }
  }

  std::vector<evaluation::MatchingResult> evaluate(const Config& config, Device& device, bool with_figures) const {
    Progress progress(quiet_);
    std::vector<evaluation::MatchingResult> results;
    for (const auto& source : sources_) {
      evaluation::MatchingOptions options;
      options.frames = frames_;
      options.tolerance = tolerance_;
      options.distributions = with_figures;
      if (!html_.empty() || !draw_.empty()) options.draw_frame = std::numeric_limits<int>::max();
      options.progress = [&](int done, int all) { progress.update(source->name(), done, all); };
      results.push_back(evaluation::evaluate_matching(*source, device, config, options));
      const auto& frames = results.back().frames;
      for (std::size_t f = 0; f < frames.size(); ++f) {
        if (!frames[f].message.empty())
          note("warning: " + source->name() + ", frame " + std::to_string(f) + ": " + frames[f].message);
      }
    }
    return results;
  }

  int run_sweep(const Config& config, Device& device) const {
    const Sweep sweep = parse_sweep(sweep_);
    for (std::size_t i = 0; i < sweep.values.size(); ++i) {
      const auto summary =
          evaluation::summarise(evaluate(with_value(config, sweep.key, sweep.values[i]), device, false));
      if (i == 0) print_sweep_heading(sweep.key, summary, sweep.stereo_orders, sweep.temporal_orders);
      print_sweep_line(sweep.values[i], summary, sweep.stereo_orders, sweep.temporal_orders);
    }
    return 0;
  }

  std::vector<std::string> paths_;
  SyntheticOptions scene_;
  std::string size_, sweep_, json_, html_, draw_;
  int frames_ = 0;
  bool force_ = false, quiet_ = false;
  evaluation::MatchingTolerance tolerance_;
  MethodOptions method_;
  std::vector<std::unique_ptr<evaluation::MatchingSource>> sources_;
};

}  // namespace

std::unique_ptr<Command> make_evaluate_matching_command() { return std::make_unique<EvaluateMatchingCommand>(); }

}  // namespace quadedge::cli
