#include "report/batch_report.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "data/text.hpp"
#include "quadedge/error.hpp"
#include "report/html_page.hpp"
#include "report/number_text.hpp"
#include "report/report_tables.hpp"
#include "report/sequence_plots.hpp"

namespace quadedge::report {
namespace {

/// How much of the results a page shows. The first one that makes the page small enough is taken.
struct Detail {
  int points;           ///< of a curve
  int thumbnail_width;  ///< px; 0: no pictures
  int quality;          ///< of the pictures, JPEG
};
constexpr std::array<Detail, 6> kDetails = {
    {{2000, 480, 75}, {600, 480, 60}, {300, 320, 55}, {200, 260, 50}, {120, 200, 50}, {60, 0, 0}}};

/// The picture in the size of the page's detail; empty for a file that cannot be read.
std::vector<std::uint8_t> reduced(const std::string& file, const Detail& detail) {
  std::vector<std::uint8_t> encoded;
  if (data::irregular_kind(file).empty()) {
    std::ifstream stream(file, std::ios::binary);
    encoded.assign(std::istreambuf_iterator<char>(stream), {});
  }
  cv::Mat picture;
  if (!encoded.empty()) picture = cv::imdecode(encoded, cv::IMREAD_COLOR);
  if (picture.empty()) return {};
  const double scale = static_cast<double>(detail.thumbnail_width) / picture.cols;
  if (scale < 1) cv::resize(picture, picture, {}, scale, scale, cv::INTER_AREA);
  std::vector<std::uint8_t> small;
  cv::imencode(".jpg", picture, small, {cv::IMWRITE_JPEG_QUALITY, detail.quality});
  return small;
}

/// "thumbnail_000123.jpg" shows frame 123.
std::string frame_of(const std::string& file) {
  const std::string stem = std::filesystem::path(file).stem().string();
  const auto digits = stem.find_first_of("123456789");
  return "frame " + (digits == std::string::npos ? "0" : stem.substr(digits));
}

void add_overview(HtmlPage& page, const std::vector<SequenceResults>& sequences, const std::string& baseline,
                  const std::vector<Peer>& peers) {
  int ran = 0, frames = 0, tracked = 0;
  bool shared = false;
  std::string device;
  for (const auto& sequence : sequences) {
    if (!sequence.ran()) continue;
    ++ran;
    frames += sequence.row.frames;
    tracked += sequence.row.tracked;
    shared = shared || sequence.row.member.jobs > 1;
    if (device.find(sequence.row.device) == std::string::npos)
      device += (device.empty() ? "" : ", ") + sequence.row.device;
  }
  page.heading(2, "Overview");
  std::vector<std::pair<std::string, std::string>> facts = {
      {"Program", "QuadEdge " QUADEDGE_VERSION},
      {"Device", device.empty() ? "-" : device},
      {"Sequences", std::to_string(ran) + " of " + std::to_string(sequences.size()) + " finished"},
      {"Frames tracked", share_text(tracked, frames)}};
  if (!baseline.empty())
    facts.emplace_back("Baseline", baseline + "; differences to it stand in brackets, '=' is none in these digits");
  for (const auto& peer : peers) facts.emplace_back("Compared with", peer.name + " (" + peer.folder + ")");
  page.definitions(facts);
  std::vector<std::pair<std::string, std::string>> failures;
  for (const auto& sequence : sequences) {
    if (sequence.row.status != MemberStatus::done) {
      failures.emplace_back(sequence.row.member.name,
                            std::string(to_string(sequence.row.status)) + ": " + sequence.row.member.message);
    }
  }
  if (!failures.empty()) {
    page.heading(3, "Sequences that did not end well");
    page.definitions(failures);
  }
  page.table(error_table(sequences, peers, &SummaryAccuracy::origin_aligned,
                         "Errors, origin-aligned as in the paper's Table 4 (the first compared poses are made equal)"));
  page.table(error_table(sequences, peers, &SummaryAccuracy::se3_aligned,
                         "Errors, SE(3)-aligned as others often quote (least squares over all positions, no scale)"));
  page.table(latency_table(sequences));
  page.paragraph(
      std::string("Latency is from both images in host memory to the pose.") +
      (shared ? " Several sequences ran at the same time, so latencies are longer than those of a lone run." : ""));
}

void add_sequence(HtmlPage& page, const SequenceResults& sequence, const Detail& detail) {
  const SummaryRow& row = sequence.row;
  page.heading(2, row.member.name);
  if (!sequence.ran()) {
    page.paragraph(std::string(to_string(row.status)) + ": " + row.member.message);
    return;
  }
  std::vector<std::pair<std::string, std::string>> facts = {
      {"Recording", row.member.path + " (" + row.member.format + ")"},
      {"Frames tracked", share_text(row.tracked, row.frames)}};
  if (row.accuracy) {
    facts.emplace_back("Path", significant(row.accuracy->path_length_m) + " m, drift at its end " +
                                   significant(row.accuracy->end_drift_percent) + " %");
  }
  for (const auto& note : sequence.notes) facts.emplace_back("Note", note);
  page.definitions(facts);
  const bool truth = !sequence.truth.empty();
  page.plots(trajectory_plots(sequence, detail.points),
             truth ? "In the left camera's first pose that has ground truth, origin-aligned."
                   : "In the left camera's first pose.");
  if (truth) page.plots(error_plots(sequence, detail.points), "Errors against ground truth, origin-aligned.");
  page.plots(frame_plots(sequence, detail.points), "");
  if (detail.thumbnail_width == 0 || sequence.thumbnails.empty()) return;
  std::vector<HtmlPage::Picture> pictures;
  for (const auto& file : sequence.thumbnails) {
    auto picture = reduced(file, detail);
    if (picture.empty()) {
      page.paragraph(file + ": no picture that can be read");
    } else {
      pictures.push_back({std::move(picture), "image/jpeg", frame_of(file)});
    }
  }
  page.pictures(pictures);
  page.paragraph(
      "Dots: stereo edges, brighter ones have larger disparities. Lines: motion of quads since the frame that they "
      "were "
      "matched with, white for inliers, red for others, one per cell of 16 px.");
}

}  // namespace

std::string batch_report_html(const std::string& output, const std::string& baseline, const std::vector<Peer>& peers) {
  const SummarisedBatch batch = summarised_batch(output);
  if (!baseline.empty()) summarised_batch(baseline);  // complain where it is no batch
  std::vector<SequenceResults> sequences;
  for (const auto& name : batch.names)
    sequences.push_back(read_sequence_results(output, name, batch.min_tracked, baseline, peers));
  std::string html;
  for (const auto& detail : kDetails) {
    HtmlPage page("QuadEdge batch " + std::filesystem::absolute(output).lexically_normal().filename().string());
    add_overview(page, sequences, baseline, peers);
    for (const auto& sequence : sequences) add_sequence(page, sequence, detail);
    if (&detail != &kDetails.front())
      page.paragraph("Curves are thinned and pictures reduced so that this page stays small.");
    html = page.html();
    if (html.size() <= kLargestReport) break;
  }
  return html;
}

}  // namespace quadedge::report
