#include "report/matching_html.hpp"

#include <cmath>

#include "report/canvas.hpp"
#include "report/draw_matches.hpp"
#include "report/html_page.hpp"
#include "report/matching_html_tables.hpp"
#include "report/matching_plots.hpp"

namespace quadedge::report {
namespace {

using evaluation::CueTable;
using evaluation::MatchingResult;
using evaluation::MatchingSummary;

constexpr std::size_t kPictureBytes = 3'100'000;  // of all pictures together, before base64 adds a third
constexpr std::size_t kMostDrawn = 8;             // pairs or sequences

/// "stereo.ncc_min = 0.7" for every constant that is not the default.
std::string changed_constants(const Config& config) {
  const Config defaults;
  std::string text;
  for (const Constant& constant : constants()) {
    const std::string value = constant.text(config);
    if (value != constant.text(defaults)) text += (text.empty() ? "" : ", ") + constant.key() + " = " + value;
  }
  return text.empty() ? "all at their defaults" : text;
}

void add_facts(HtmlPage& page, const MatchingReportFacts& facts) {
  page.definitions(
      {{"program", std::string("QuadEdge ") + QUADEDGE_VERSION},
       {"device", facts.device.name + ", " + facts.device.opencl + ", driver " + facts.device.driver},
       {"constants", changed_constants(facts.config)},
       {"veridical",
        "within " + axis_text(facts.tolerance.position) + " px of the true position, in a view that shows it"},
       {"pool: paired",
        "edges whose counterpart was detected (the paper's pool): recall starts at 100 % by construction"},
       {"pool: all", "all edges of known truth, also those whose counterpart is occluded or was not detected"},
       {"recall", "fraction of the pool's edges that still have a veridical candidate"},
       {"precision", "veridical candidates / all candidates"},
       {"ambiguity", "candidates beyond the first, per edge that has any"},
       {"\u00b1", "standard deviation over frames; every pair is one"}});
}

/// What the pipeline complained about: lost frames, capacities that ran out.
void add_messages(HtmlPage& page, const std::vector<MatchingResult>& results) {
  constexpr std::size_t kMost = 12;
  std::vector<std::pair<std::string, std::string>> messages;
  for (const auto& result : results) {
    for (std::size_t f = 0; f < result.frames.size(); ++f) {
      if (result.frames[f].message.empty()) continue;
      messages.emplace_back(result.name + ", frame " + std::to_string(f), result.frames[f].message);
    }
  }
  if (messages.empty()) return;
  if (messages.size() > kMost) {
    const std::string more = std::to_string(messages.size() - kMost) + " more frames";
    messages.resize(kMost);
    messages.emplace_back("and", more);
  }
  page.paragraph("The pipeline says:");
  page.definitions(messages);
}

void add_summary_tables(HtmlPage& page, const MatchingSummary& summary) {
  page.table(filter_table("Table 1: stereo", summary.stereo));
  page.table(disparity_table(summary));
  if (summary.temporal_frames == 0) return;
  page.table(filter_table("Table 2: in time, left images", summary.temporal_left));
  page.table(filter_table("Table 2: in time, right images", summary.temporal_right));
  page.table(quad_table(summary));
  if (summary.constraints[0].counts.pairs > 0) page.table(constraint_table(summary));
}

/// Plots of one cascade, two cues side by side.
void add_cues(HtmlPage& page, const std::vector<evaluation::CueDistribution>& cues, CueTable table,
              const std::string& title, const std::string& caption) {
  std::vector<std::string> svgs;
  for (const auto& cue : cues) {
    if (cue.table != table || cue.veridical.total() + cue.other.total() == 0) continue;
    for (auto& svg : cue_plots(cue)) svgs.push_back(std::move(svg));
  }
  if (svgs.empty()) return;
  page.heading(3, title);
  page.plots(svgs, caption);
}

void add_distributions(HtmlPage& page, const MatchingSummary& summary) {
  page.heading(2, "Distributions of the cues");
  page.paragraph(
      "Each cue over the pairs that reach the filter which judges it, edges of the pool \"paired\" alone. The number "
      "before "
      "a cue is that of its filter. Densities are normalised over the range shown, cumulative curves over all pairs: "
      "one that ends low has the rest beyond the range. Dashed: the threshold.");
  const std::string sample =
      " Of the other pairs before the first filter, 40 per edge are drawn; the count beside a curve is that of the "
      "pairs looked at.";
  add_cues(page, summary.cues, CueTable::stereo, "Stereo (Figure 3)", "Veridical and other stereo pairs." + sample);
  add_cues(page, summary.cues, CueTable::temporal_left, "In time, left images (Figure 5)",
           "Veridical and other pairs in time." + sample);
  add_cues(page, summary.cues, CueTable::temporal_right, "In time, right images (Figure 5)",
           "Veridical and other pairs in time." + sample);
  add_cues(page, summary.cues, CueTable::constraints, "Pairs of quads (Figure 6)",
           "What the constraints of Equation 9 compare, over the pairs of quads that fulfil all constraints before; "
           "veridical: both "
           "quads are. The sixth constraint, equal handedness, has no threshold.");
}

void add_accuracy(HtmlPage& page, const std::vector<MatchingResult>& results) {
  const AccuracyPlots plots = accuracy_plots(results);
  if (plots.points == 0) return;
  page.heading(2, "Precision of pairs and accuracy of motions");
  const auto correlation = [](double value) {
    return std::isfinite(value) ? fixed(value, 2) : std::string("undefined");
  };
  page.plots(plots.svgs,
             "Figure 7. Above: one point per frame and constraint; every pair of quads that fulfils the constraints so "
             "far gives a motion "
             "(Proposition 2), whose error against the true motion is taken, median over up to 2000 pairs. Rank "
             "correlation of "
             "precision and error: rotation " +
                 correlation(plots.rotation_correlation) + ", translation " +
                 correlation(plots.translation_correlation) + " over " + std::to_string(plots.points) +
                 " points. Below: the error of the motion that the pipeline found from all quads of the frame.");
}

void add_drawings(HtmlPage& page, const std::vector<MatchingResult>& results, const MatchingReportFacts& facts) {
  std::vector<std::pair<const MatchingResult*, std::vector<MatchDrawing>>> all;
  std::size_t pictures = 0, left_out = 0;
  for (const auto& result : results) {
    if (!result.drawn) continue;
    if (all.size() == kMostDrawn) {
      ++left_out;
      continue;
    }
    all.emplace_back(&result,
                     draw_matches(*result.drawn, result.name, facts.tolerance.position, facts.tolerance.wrong));
    pictures += all.back().second.size();
  }
  if (pictures == 0) return;
  page.heading(2, "Drawings");
  page.paragraph(
      "The left and the right image with the final stereo edges of known truth (Figures 8 and 9); numbered frames mark "
      "what "
      "is enlarged below." +
      (left_out > 0
           ? " The first " + std::to_string(kMostDrawn) + " of " + std::to_string(kMostDrawn + left_out) + " are shown."
           : std::string()));
  for (std::size_t r = 0; r < all.size(); ++r) {
    if (all.size() > 1) page.begin_fold(all[r].first->name, r == 0);
    for (const auto& drawing : all[r].second) {
      page.picture(encode_jpeg(drawing.picture, kPictureBytes / pictures), "image/jpeg", drawing.caption);
    }
    if (all.size() > 1) page.end_fold();
  }
}

}  // namespace

std::string matching_html(const std::vector<MatchingResult>& results, const MatchingReportFacts& facts) {
  const MatchingSummary summary = evaluation::summarise(results);
  HtmlPage page(results.size() == 1 ? "Matching: " + results[0].name
                                    : "Matching: " + std::to_string(results.size()) + " data sets");
  add_facts(page, facts);
  page.heading(2, "Overview");
  page.table(overview_table(results, summary));
  add_messages(page, results);
  page.heading(2, results.size() > 1 ? "Tables, pooled" : "Tables");
  add_summary_tables(page, summary);
  std::vector<std::string> plots = {filter_plot("Stereo, after every filter", summary.stereo)};
  if (summary.temporal_frames > 0) {
    plots.push_back(filter_plot("In time, left images, after every filter", summary.temporal_left));
    plots.push_back(filter_plot("In time, right images, after every filter", summary.temporal_right));
  }
  page.plots(plots, "");
  page.plots(disparity_error_plots(results),
             "Final stereo edges whose true position is visible: found minus true disparity.");
  if (results.size() > 1) {
    for (const auto& result : results) {
      page.begin_fold("Tables of " + result.name, false);
      add_summary_tables(page, evaluation::summarise({result}));
      page.end_fold();
    }
  }
  page.heading(2, "Counts per frame");
  page.table(count_table(results));
  if (summary.frames > 1)
    page.plots(count_plots(results), "Figure 2: edges, stereo edges, pairs in time and quads of every frame.");
  add_distributions(page, summary);
  add_accuracy(page, results);
  add_drawings(page, results, facts);
  return page.html();
}

}  // namespace quadedge::report
