#pragma once
/// \file video_file.hpp  Reads a video file as grey images, through the programs ffprobe and ffmpeg.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "data/stream_reader.hpp"

namespace quadedge::data {

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

/// One frame of a video.
struct VideoPicture {
  std::int64_t stamp_ns = 0;  ///< relative to the first frame; from the frame rate if the file has no timestamps
  Image image;
};

/// Decodes a video: each call returns the next frame, or nothing after the last one. Grey values equal those of the
/// images from which the video was made. Grey frames are unchanged, at their bit depth. For YCbCr, the luma is used
/// and, if recorded in the broadcast range, stretched to the full range. Other formats are converted to RGB, and then
/// to grey as for a colour image file. \throws DataError if ffmpeg is not installed; at a call, for a damaged frame, a
/// frame that differs in size from the first, and if the file has fewer frames than its header announces
std::function<std::optional<VideoPicture>()> decode_video(const Video& video);

/// Stereo pairs of two videos, or of one with both views (`right` is empty). Its readers throw DataError that names the
/// file, if one video ends before the other or, without `options.fps`, if the times of a pair's frames differ.
std::shared_ptr<StreamOfReaders> make_video_stream(const Video& left, const std::optional<Video>& right,
                                                   const StreamOptions& options);

}  // namespace quadedge::data
