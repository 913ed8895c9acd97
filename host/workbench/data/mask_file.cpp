/// \file mask_file.cpp  Masks of a camera, drawn by the user and transferred to the pinhole image, and masks of frames.

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "data/image_file.hpp"
#include "data/text.hpp"
#include "quadedge/calibration.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/error.hpp"

namespace quadedge {
namespace {

/// Hides every pixel of the view whose grey level is interpolated from a black pixel of the mask.
void hide(const Image& drawn, const PinholeCamera& camera, const UndistortionTable& table, PixelMask& mask) {
  if (mask.empty()) {
    mask = {camera.width, camera.height, {}};
    mask.hidden.resize(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
  }
  const ImageView view = drawn.view();
  for (std::size_t i = 0; i < mask.hidden.size(); ++i) {
    const auto width = static_cast<std::size_t>(camera.width);
    const float x = table.empty() ? static_cast<float>(i % width) : table.source_x[i];
    const float y = table.empty() ? static_cast<float>(i / width) : table.source_y[i];
    const auto within = [](float place, int last) { return std::clamp(static_cast<int>(place), 0, last); };
    for (const float row : {std::floor(y), std::ceil(y)})
      for (const float column : {std::floor(x), std::ceil(x)})
        if (view.value(within(column, view.width - 1), within(row, view.height - 1)) == 0) mask.hidden[i] = 1;
  }
}

/// The mask of an image. \throws DataError if there is none
std::string mask_of(const std::string& image, const std::filesystem::path& folder) {
  const std::string file = (folder / std::filesystem::path(image).stem()).string() + ".png";
  if (!std::filesystem::is_regular_file(file))
    data::fail(file, "no file", "the mask of " + image + ": black where nothing is to be tracked");
  return file;
}

}  // namespace

void mask_rig(StereoRig& rig, const std::string& files) {
  const auto list = data::file_list(files);
  const auto apply = [](const std::string& file, const PinholeCamera& camera, const UndistortionTable& table,
                        PixelMask& mask) {
    const Image drawn = data::read_mask(file);
    if (data::size_of(drawn) != data::size_of(camera))
      data::fail(file, "a mask of " + data::to_string(data::size_of(drawn)) + " pixels",
                 data::to_string(data::size_of(camera)) + ", the size of the images");
    hide(drawn, camera, table, mask);
    if (std::count(mask.hidden.begin(), mask.hidden.end(), 0) == 0)
      data::fail(file, "a mask that is black everywhere", "black where no edges are wanted, white elsewhere");
  };
  apply(list.front(), rig.left, rig.left_undistortion, rig.left_mask);
  apply(list.back(), rig.right, rig.right_undistortion, rig.right_mask);
}

void add_masks(Dataset& dataset, const std::string& folder) {
  if (dataset.stream)
    throw UsageError("--masks " + folder + ": the frames of " + dataset.path +
                     " have no names; expected a recording of image files");
  const std::filesystem::path left = std::filesystem::path(folder) / "left", right = left.parent_path() / "right";
  const bool has_left = std::filesystem::is_directory(left), has_right = std::filesystem::is_directory(right);
  if (!has_left && !has_right)
    data::fail(folder, "no folder left or right", "masks of a camera's images in one of them");
  for (FrameFiles& frame : dataset.frames) {
    if (has_left) frame.left_mask = mask_of(frame.left, left);
    if (has_right) frame.right_mask = mask_of(frame.right, right);
  }
}

}  // namespace quadedge
