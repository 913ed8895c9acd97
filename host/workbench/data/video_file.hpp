#pragma once
/// \file video_file.hpp  Reads a video file as grey images, through the programs ffprobe and ffmpeg.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

#include "data/stream_reader.hpp"

namespace quadedge::data {

// Another program as a source of data.

/// A running program with an empty standard input. It is killed with this object; where this process dies without
/// destructors, it ends at its next output. A terminal's Ctrl-C does not reach it.
class ProgramOutput {
 public:
  /// Starts a program that is found as a shell finds it. \throws DataError with `needed_for` if it is not installed
  ProgramOutput(const std::vector<std::string>& command, const std::string& needed_for);
  ~ProgramOutput();
  ProgramOutput(const ProgramOutput&) = delete;
  ProgramOutput& operator=(const ProgramOutput&) = delete;

  /// Waits until something was appended to `output` or `messages`, or one of them ended. \returns false if both have
  bool wait();

  std::string output, messages;  ///< from standard output and standard error; taken out by whoever uses it

 private:
  pid_t process_ = -1;
  int pipes_[2] = {-1, -1};  ///< of output and messages; -1 once ended
};

/// The first video of a file, as ffprobe describes it.
struct Video {
  std::string file;
  std::string demuxer;     ///< name of ffmpeg's reader of the container; empty if it is the decoder's, too
  std::string grey;        ///< ffmpeg's filter that gives grey frames, or R, G, B
  bool broadcast = false;  ///< whether 16 to 235 (for 8 bits) stand for black to white
  bool has_times = false;  ///< whether its frames have timestamps
  int delay = 0;           ///< most frames that the decoder holds back
  double fps = 0;          ///< frames per second; 0 if unknown
  int promised = 0;        ///< number of frames: from the header, or duration times frame rate; 0 if unknown
};

/// \throws DataError for a file that is missing or not a video, and if ffprobe is not installed
Video describe_video(const std::string& file);

/// Decodes a video frame by frame.
///
/// Grey values equal those of the images from which the video was made. Grey frames are unchanged, at their bit depth.
/// For YCbCr, the luma is used and, if recorded in the broadcast range, stretched to the full range. Other formats are
/// converted to RGB, and then to grey as for a colour image file.
class VideoFile {
 public:
  /// One frame.
  struct Picture {
    std::int64_t stamp_ns = 0;  ///< relative to the first frame; from the frame rate if the file has no timestamps
    Image image;
  };

  /// \throws DataError if ffmpeg is not installed
  explicit VideoFile(Video video);
  ~VideoFile();

  /// Returns the next frame, or nothing after the last one. \throws DataError for a damaged frame, a frame that differs
  /// in size from the first, and if the file has fewer frames than its header announces
  std::optional<Picture> next();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Stereo pairs of two videos, or of one with both views (`right` is empty). Its readers throw DataError that names the
/// file, if one video ends before the other or, without `options.fps`, if the times of a pair's frames differ.
std::shared_ptr<StreamOfReaders> make_video_stream(const Video& left, const std::optional<Video>& right,
                                                   const StreamOptions& options);

}  // namespace quadedge::data
