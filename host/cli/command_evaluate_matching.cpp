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

constexpr int kRenderedFrames = 10;  // of a built-in scene, unless --frames says otherwise

class EvaluateMatchingCommand : public Command {
 public:
  EvaluateMatchingCommand()
      : Command("evaluate matching", "recall, precision and ambiguity after every filter (Tables 1 to 3)",
                "  quadedge evaluate matching two_view_training/terrace_2s --html terrace.html --json terrace.json\n"
                "  quadedge evaluate matching room --frames 5 --stereo.ncc_min 0.8") {}
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
    report::check_output_file(html_, force_);
    place_data_of_page();
    report::refuse_shared_files({html_, json_}, {});
    report::check_output_file(json_, force_);
    report::refuse_full_folder(draw_, force_);
    const Config config = method_.config();
    open_sources();
    Device device = method_.open_device();
    const auto results = evaluate(config, device);
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

  std::vector<evaluation::MatchingResult> evaluate(const Config& config, Device& device) const {
    Progress progress(quiet_);
    std::vector<evaluation::MatchingResult> results;
    for (const auto& source : sources_) {
      evaluation::MatchingOptions options;
      options.frames = frames_;
      options.tolerance = tolerance_;
      options.distributions = true;
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

  std::vector<std::string> paths_;
  SyntheticOptions scene_;
  std::string size_, json_, html_, draw_;
  int frames_ = 0;
  bool force_ = false, quiet_ = false;
  evaluation::MatchingTolerance tolerance_;
  MethodOptions method_;
  std::vector<std::unique_ptr<evaluation::MatchingSource>> sources_;
};

}  // namespace

std::unique_ptr<Command> make_evaluate_matching_command() { return std::make_unique<EvaluateMatchingCommand>(); }

}  // namespace quadedge::cli
