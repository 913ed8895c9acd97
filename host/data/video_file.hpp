#pragma once
/// \file video_file.hpp  A video file as grey images.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "quadedge/image.hpp"

namespace quadedge::data {

/// Decodes the first video of a file, picture by picture, with libavformat and libavcodec. (OpenCV's reader would hide
/// what matters here: it stretches a picture of another size, passes over damage, and knows 8 bits alone.)
///
/// Grey values are those of the images that the video was made of: grey pictures stay as they are, at their depth; of
/// YCbCr the luma is taken, stretched to full range where it is recorded in the broadcast range (16 to 235 of 8 bits);
/// other colours become BGR, and these grey as the colour of an image file does.
class VideoFile {
 public:
  /// One picture.
  struct Picture {
    std::int64_t stamp_ns = 0;  ///< in the video, the first at 0; by the frame rate where the file holds no times
    Image image;
  };

  /// \throws DataError for a file that is missing, no video, or of colours that have no grey.
  explicit VideoFile(const std::string& path);
  ~VideoFile();

  /// The next picture, or nothing after the last one. \throws DataError for a picture that is damaged or of another
  /// size than the first, and where the file ends before the pictures that it says it holds.
  std::optional<Picture> next();

  /// Pictures that the file says it holds: as many as its head lists, or its duration times its rate; 0: it does not
  /// say.
  int promised() const;
  double fps() const;  ///< pictures per second; 0: it does not say

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace quadedge::data
