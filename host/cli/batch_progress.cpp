#include "cli/batch_progress.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>

namespace quadedge::cli {

int FrameCounter::frames() {
  std::ifstream file(file_, std::ios::binary);
  if (!file) return frames_;
  file.seekg(read_);
  char buffer[4096];
  while (file.read(buffer, sizeof buffer), file.gcount() > 0) {
    read_ += file.gcount();
    frames_ += static_cast<int>(std::count(buffer, buffer + file.gcount(), '\n'));
  }
  return frames_;
}

BatchProgress::BatchProgress(bool quiet, int sequences, int already, double pixels)
    : status_(quiet),
      start_(std::chrono::steady_clock::now()),
      sequences_(sequences),
      already_(already),
      pixels_(pixels) {}

void BatchProgress::finished(const std::string& name, int frames, double pixels, const std::string& sentence) {
  ++over_;
  frames_ += frames;
  pixels_over_ += pixels;
  status_.say("[" + std::to_string(already_ + over_) + "/" + std::to_string(already_ + sequences_) + "] " + name +
              ": " + sentence);
}

void BatchProgress::update(const std::vector<Running>& running, double pixels) {
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  std::string text = "[" + std::to_string(already_ + over_) + "/" + std::to_string(already_ + sequences_) + "]";
  int frames = frames_;
  const char* separator = " ";
  for (const auto& sequence : running) {
    text += separator + sequence.name;
    if (sequence.frames > 0) text += " frame " + std::to_string(sequence.done) + "/" + std::to_string(sequence.frames);
    separator = ", ";
    frames += sequence.done;
  }
  const double done = pixels_over_ + pixels;
  if (frames > 0 && seconds > 0) {
    char rate[48];
    std::snprintf(rate, sizeof rate, "  %.1f frames/s", frames / seconds);
    text += rate;
  }
  // Pixels tell more about the time that is left than frames: sequences differ in their size.
  if (done > 0) text += ", " + duration_text(seconds * std::max(0.0, pixels_ - done) / done) + " left";
  status_.show(text);
}

}  // namespace quadedge::cli
