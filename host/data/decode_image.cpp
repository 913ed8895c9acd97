#include <cstring>
#include <stdexcept>

#include "data/image_file.hpp"
#include "data/jpeg_codec.hpp"
#include "data/png_codec.hpp"
#include "data/samples.hpp"
#include "data/text.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/image.hpp"

namespace quadedge {
namespace {

using data::ImageKind;

constexpr double kMostPixels = 1 << 30;

cv::Mat decode_pnm(std::string_view bytes, const std::string& name) {
  const data::PnmHeader header = data::read_pnm_header(bytes, name);
  const int depth = header.size.max_value > kMaxValue8 ? CV_16U : CV_8U;
  cv::Mat samples(header.size.height, header.size.width, CV_MAKETYPE(depth, header.channels));
  std::memcpy(samples.data, bytes.data() + header.pixels, samples.total() * samples.elemSize());
  data::from_big_endian(samples);
  return samples;
}

cv::Mat decode(ImageKind kind, std::string_view bytes, const std::string& name) {
  if (kind == ImageKind::png) return data::decode_png(bytes);
  if (kind == ImageKind::jpeg) return data::decode_jpeg(bytes);
  return decode_pnm(bytes, name);
}

}  // namespace

Image read_grey_image(const std::string& path) { return decode_grey_image(data::read_bytes(path), path); }

Image decode_grey_image(std::string_view bytes, const std::string& name) {
  const data::ImageSize size = data::check_complete(bytes, name);
  const ImageKind kind = data::image_kind(bytes, name);
  const std::string intact = "an intact " + data::to_string(size) + " image";
  if (static_cast<double>(size.width) * size.height > kMostPixels)
    data::fail(name, "an image of " + data::to_string(size) + " pixels", "2^30 pixels at most");
  cv::Mat samples;
  try {
    samples = decode(kind, bytes, name);
  } catch (const std::runtime_error& problem) {
    data::fail(name,
               std::string("a damaged ") + (kind == ImageKind::png ? "PNG" : "JPEG") + " (" + problem.what() + ")",
               intact);
  } catch (const cv::Exception& problem) {
    data::fail(name, "an image that cannot be decoded (" + problem.err + ")", intact);
  }
  if (samples.cols != size.width || samples.rows != size.height ||
      (samples.depth() == CV_16U) != (size.max_value > kMaxValue8))
    data::fail(name, "an image of another size or depth than its header says", intact);
  return data::grey_image(samples, size.max_value);
}

}  // namespace quadedge
