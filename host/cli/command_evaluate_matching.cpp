/// \file command_evaluate_matching.cpp  quadedge evaluate matching: what every filter keeps and loses.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "cli/command.hpp"
#include "cli/console.hpp"
#include "cli/frame_source.hpp"
#include "cli/matching_tables.hpp"
#include "cli/method_options.hpp"
#include "cli/page_maker.hpp"
#include "cli/scene_options.hpp"
#include "data/atomic_file.hpp"
#include "evaluation/matching_observer.hpp"
#include "quadedge/error.hpp"
#include "quadedge/tap.hpp"
#include "report/draw_matches.hpp"
#include "report/matching_json.hpp"
#include "report/output_folder.hpp"

namespace quadedge::cli {
namespace {

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
      for (const auto& folder : skipped) note("warning: " + folder + ": skipped, no ground truth for edges");
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
