/// \file 02_detect_edges.cpp  Prints the third-order edges of one image: position, tangent direction and strength.
///   02_detect_edges image.png

#include <cstdio>
#include <quadedge/dataset.hpp>
#include <quadedge/error.hpp>
#include <quadedge/match_stereo.hpp>

int main(int count, char** arguments) try {
  if (count != 2) {
    std::fprintf(stderr, "usage: %s IMAGE\n", arguments[0]);
    return 2;
  }
  // PNG, JPEG, PGM or PPM; colour is converted to grey.
  const quadedge::Image image = quadedge::read_grey_image(arguments[1]);

  quadedge::Config config;
  config.edges.threshold = 4;  // grey levels per pixel: strong edges only

  // "reference" is the plain C++ implementation, which does not need OpenCL; "auto" selects a GPU or CPU device.
  quadedge::Device device("reference");
  const quadedge::EdgeSet edges = quadedge::detect_edges(image.view(), device, config);

  // A structure of arrays. The centre of the top-left pixel is (0, 0).
  std::printf("x,y,direction_rad,strength\n");
  for (std::size_t i = 0; i < edges.size(); ++i) {
    std::printf("%.3f,%.3f,%.4f,%.2f\n", edges.x[i], edges.y[i], edges.direction[i], edges.strength[i]);
  }
  return 0;
} catch (const quadedge::Error& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return static_cast<int>(error.exit_code());
}
