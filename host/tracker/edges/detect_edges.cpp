/// \file detect_edges.cpp  Threshold, maxima, mask and directions of one image, on the host or on the device.
#include "common/images.hpp"
#include "device/edge_detection.hpp"
#include "device/grid_edges.hpp"
#include "device/images.hpp"
#include "device/oracle.hpp"
#include "quadedge/error.hpp"
#include "quadedge/match_stereo.hpp"

namespace quadedge {

EdgeSet detect_edges(const ImageView& image, Device& device, const Config& config, const PixelMask& mask) {
  check_pixels(image, "the image");
  const auto use = device.use();
  EdgeSet edges;
  std::size_t found = 0;
  if (device.is_reference()) {
    edges = registered_oracle()->detect_edges(image, config, mask);
    found = edges.size();
  } else {
    auto& context = *device.context();
    stages::Undistortion upload(context, {}, image.width, image.height, config.variants, image.max_value);
    stages::PaddedPlane plane(context, image.width, image.height, config.edges.sigma, image.max_value);
    stages::EdgeThreshold threshold(context, config.edges, config.variants);
    opencl::Buffer<cl_uchar> pixels;
    stages::DeviceEdges device_edges;
    const opencl::CopyGuard guard(context);  // of the image
    upload.run(image, pixels);
    plane.prepare(pixels);
    threshold.run(plane, nullptr);
    if (config.is_paper()) {
      stages::GridEdges(context, image.width, image.height, config.edges, mask, config.variants)
          .run(plane, threshold.values(), device_edges);
    } else {
      stages::EdgeDetection detection(context, image.width, image.height, config.edges, config.variants);
      detection.find_maxima(plane, threshold.values());
      stages::EdgeMask(context, mask, config.edges.margin, detection.maxima()).run(detection.maxima());
      detection.take_directions(plane, device_edges);
    }
    device_edges.read_count();
    edges = device_edges.read(image.height);
    found = edges.size() + static_cast<std::size_t>(device_edges.host_dropped);
  }
  if (found > static_cast<std::size_t>(config.edges.max_edges)) {
    throw UsageError("the image has " + std::to_string(found) + " edges; edges.max_edges allows " +
                     std::to_string(config.edges.max_edges));
  }
  return edges;
}

}  // namespace quadedge
