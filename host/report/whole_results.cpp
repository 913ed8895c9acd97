#include "report/whole_results.hpp"

#include "data/text.hpp"
#include "quadedge/error.hpp"
#include "quadedge/trajectory.hpp"
#include "report/batch_summary.hpp"
#include "report/errors_csv.hpp"
#include "report/frames_csv.hpp"
#include "report/poses_csv.hpp"

namespace quadedge::report {
namespace {

/// A text that was cut ends within a line, or has fewer of them.
void check_end(const std::string& file) {
  const std::string text = data::read_bytes(file);
  if (text.empty() || text.back() != '\n') data::fail(file, "an end within a line", "a whole file");
}

void check_count(const std::string& file, std::size_t found, int expected) {
  if (found == static_cast<std::size_t>(expected)) return;
  data::fail(file, data::counted(found, "row"), std::to_string(expected) + " as in report.json");
}

}  // namespace

void check_whole(const std::string& folder) {
  const SummaryRow row = read_summary_row(folder, "", 0);
  if (row.status != MemberStatus::done) throw DataError(row.member.message);
  const std::string tum = folder + "/trajectory.txt", kitti = folder + "/trajectory_kitti.txt",
                    frames = folder + "/frames.csv", poses = folder + "/poses.csv", config = folder + "/config.toml",
                    truth = folder + "/groundtruth.txt", errors = folder + "/errors.csv";
  for (const auto* file : {&tum, &kitti, &frames, &poses, &config}) check_end(*file);
  check_count(tum, read_tum(tum).size(), row.tracked);
  check_count(kitti, read_kitti(kitti).size(), row.frames);
  check_count(frames, read_frames_csv(frames).rows(), row.frames);
  check_count(poses, read_poses_csv(poses).rows(), row.frames);
  if (!row.accuracy) return;
  check_end(truth);
  read_tum(truth);
  check_end(errors);
  check_count(errors, read_errors_csv(errors).rows(), row.accuracy->matched);
}

}  // namespace quadedge::report
