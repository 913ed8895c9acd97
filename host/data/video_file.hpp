#pragma once
/// \file video_file.hpp  Reads a video file as grey images.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "quadedge/image.hpp"

namespace quadedge::data {

/// Decodes the first video stream of a file, frame by frame, with libavformat and libavcodec. (OpenCV's reader is
/// unsuitable: it rescales frames of another size, ignores damage, and supports 8 bits only.)
///
/// Grey values equal those of the images from which the video was made. Grey frames are unchanged, at their bit depth.
/// For YCbCr, the luma is used and, if recorded in the broadcast range (16 to 235 for 8 bits), stretched to the full
/// range. Other formats are converted to BGR, and then to grey as for a colour image file.
class VideoFile {
 public:
  /// One frame.
  struct Picture {
    std::int64_t stamp_ns = 0;  ///< relative to the first frame; from the frame rate if the file has no timestamps
    Image image;
  };

  /// \throws DataError for a file that is missing, not a video, or in a colour format that cannot be converted to grey.
  explicit VideoFile(const std::string& path);
  ~VideoFile();

  /// Returns the next frame, or nothing after the last one. \throws DataError for a damaged frame, a frame that differs
  /// in size from the first, and if the file has fewer frames than its header announces
  std::optional<Picture> next();

  /// Number of frames according to the file: from its header, or duration times frame rate; 0 if unknown.
  int promised() const;
  double fps() const;  ///< frames per second; 0 if unknown

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace quadedge::data
