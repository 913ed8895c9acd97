#pragma once
/// \file drawing.hpp  Pictures of results as PNG files, each with its legend. All functions \throw DataError when
/// the file cannot be written.

#include <string>
#include <vector>

#include "evaluation/matching_result.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"
#include "quadedge/odometry.hpp"

namespace quadedge::report {

/// The image itself, in 8 bits.
void write_image(const std::string& path, const ImageView& image);

/// Third-order edges as short strokes along their direction, coloured by direction, over the darkened image.
void draw_edges(const std::string& path, const ImageView& image, const EdgeSet& edges);

/// The left image with the stereo edges of its pair, coloured by disparity.
void draw_stereo(const std::string& path, const ImageView& left, const StereoEdges& edges);

/// The left image with its stereo edges coloured by disparity, and the motion of the left edges of quads since the
/// earlier frame: inliers white, others red, one per cell of 16 px.
void draw_quads(const std::string& path, const ImageView& left, const FrameDetails& details);

/// Both recorded images of a frame side by side, reduced to a width of 960 px, as JPEG.
void draw_pair(const std::string& path, const ImageView& left, const ImageView& right);

/// The picture of draw_quads without its legend, reduced to a width of 480 px, as JPEG.
void draw_quads_thumbnail(const std::string& path, const ImageView& left, const FrameDetails& details);

// Final stereo edges over their image pair, as the paper's Figures 8 and 9 show them.

/// The stereo edges of known truth of one class over both images side by side, each in a colour of its own: correct
/// ones as strokes, with the regions that hold most of them enlarged below; others as markers, from which a line leads
/// to a ring at the true position in the right image. Edges that the right view does not show are drawn with the wrong
/// ones. \throws DataError.
void draw_matches(const std::string& path, const evaluation::DrawnFrame& frame, const std::string& name,
                  const evaluation::MatchingTolerance& tolerance, evaluation::MatchClass kind);

/// A drawing that was written.
struct WrittenDrawing {
  std::string name;     ///< of the result that it shows
  std::string file;     ///< with the folder, absolute
  std::string caption;  ///< what it shows
};

/// Writes FOLDER/NAME_{correct,inaccurate,wrong}.png of every result with a frame to draw; the second result of one
/// name gets a "_2". Makes the folder. \throws DataError.
std::vector<WrittenDrawing> write_match_drawings(const std::string& folder,
                                                 const std::vector<evaluation::MatchingResult>& results,
                                                 const evaluation::MatchingTolerance& tolerance);

}  // namespace quadedge::report
