#include "quadedge/result_files.hpp"

#include "common/timing.hpp"
#include "data/atomic_file.hpp"
#include "report/config_toml.hpp"
#include "report/json.hpp"
#include "report/output_folder.hpp"
#include "report/result_rows.hpp"
#include "report/run_record.hpp"

namespace quadedge {

struct ResultFiles::Open {
  Open(const std::string& path, bool force) : folder(path), lock(report::prepare_output_folder(path, force)) {}

  std::string folder;
  report::FolderLock lock;
  report::RunRecord run;
  report::GrowingFiles rows{folder};
  Clock::time_point start = Clock::now();
};

ResultFiles::ResultFiles(const std::string& folder, const StereoOdometry& odometry, const ResultOrigin& origin,
                         bool force)
    : open_(std::make_unique<Open>(folder, force)) {
  report::RunRecord& run = open_->run;
  run.command = origin.command;
  run.input.format = "live";
  run.input.name = run.input.path = origin.name;
  run.input.width = odometry.rig().left.width;
  run.input.height = odometry.rig().left.height;
  run.device = odometry.device();
  run.self_test.verdict = "not run";
  run.config = odometry.config();
  run.variants = odometry.variants();
  run.start_ms = run.kernel_build_ms = odometry.kernel_build_ms();
  run.device_peak_mb = static_cast<double>(odometry.device_bytes()) / (1024.0 * 1024.0);
  data::write_atomically(folder + "/config.toml", report::config_toml(run.config, run.device.name));
}

ResultFiles::~ResultFiles() = default;
ResultFiles::ResultFiles(ResultFiles&&) noexcept = default;

void ResultFiles::add(const FrameResult& result) {
  report::FrameRecord record;
  record.start_ms = milliseconds_since(open_->start) - result.timing.latency_ms;
  record.result = result;
  open_->rows.add(result);
  open_->run.frames.push_back(std::move(record));
}

void ResultFiles::finish(const std::string& ended_early) {
  report::RunRecord& run = open_->run;
  run.ended_early = ended_early;
  run.input.frames = static_cast<int>(run.frames.size());
  run.host_peak_mb = host_peak_mb();
  data::write_atomically(open_->folder + "/report.json", report::report_json(run));
}

}  // namespace quadedge
