/// \file place_words.cpp  Makes the table of words of host/tracker/places/place_store.hpp from rendered scenes: a
/// projection on the principal axes of their wide descriptors, and words by k-means. The same table on every run.
///
///   place_words > host/tracker/places/place_words.bin

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdio>
#include <exception>
#include <random>

#include "motion/latest_frame.hpp"
#include "places/place_store.hpp"
#include "quadedge/odometry.hpp"
#include "quadedge/synthetic.hpp"

namespace {

using namespace quadedge;
using places::kWordNumbers;
using places::kWords;

constexpr int kFrames = 73, kEveryFrame = 6, kEveryEdge = 8, kRounds = 20;
constexpr int kSeeds = 2;            ///< scenes of each kind
constexpr float kWhitening = 0.25F;  ///< exponent of the variance by which an axis is divided

using Descriptors = Eigen::Matrix<float, kWideBytes, Eigen::Dynamic>;
using Projected = Eigen::Matrix<float, kWordNumbers, Eigen::Dynamic>;

/// Appends some descriptors of every chosen view of a scene.
void describe(const std::string& scene, std::uint64_t seed, Descriptors& all) {
  SyntheticOptions options;
  options.scene = scene;
  options.path = "loop";
  options.frames = kFrames;
  options.seed = seed;
  options.width = 640;
  options.height = 400;
  options.focal = 400;
  options.baseline = 0.1;
  options.supersampling = 2;
  const SyntheticSequence sequence(options);
  StereoOdometry odometry(sequence.rig());
  for (int frame = 0; frame < kFrames; frame += kEveryFrame) {
    odometry.track(sequence.pair(frame).view());
    const Descriptors view =
        places::rooted_descriptors(frontend::as_global(odometry::LatestFrame::of(odometry).frontend).keep());
    Eigen::Index next = all.cols();
    all.conservativeResize(Eigen::NoChange, next + (view.cols() + kEveryEdge - 1) / kEveryEdge);
    for (Eigen::Index i = 0; i < view.cols(); i += kEveryEdge) all.col(next++) = view.col(i);
  }
}

/// Means of the descriptors nearest to each word, repeatedly.
void improve(const Projected& descriptors, Eigen::Matrix<float, kWordNumbers, kWords>& words) {
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix<float, kWordNumbers, kWords> sums = Eigen::Matrix<float, kWordNumbers, kWords>::Zero();
    Eigen::Matrix<float, kWords, 1> counts = Eigen::Matrix<float, kWords, 1>::Zero();
    for (Eigen::Index i = 0; i < descriptors.cols(); ++i) {
      Eigen::Index word = 0;
      (words.colwise() - descriptors.col(i)).colwise().squaredNorm().minCoeff(&word);
      sums.col(word) += descriptors.col(i);
      counts[word] += 1;
    }
    for (int word = 0; word < kWords; ++word)
      if (counts[word] > 0) words.col(word) = sums.col(word) / counts[word];
  }
}

/// The numbers with five decimals, columns one after another.
template <class Matrix>
void write(const Matrix& matrix) {
  for (Eigen::Index i = 0; i < matrix.size(); ++i) {
    const auto rounded = static_cast<float>(std::round(1e5 * static_cast<double>(matrix.data()[i])) / 1e5);
    std::fwrite(&rounded, sizeof rounded, 1, stdout);
  }
}

void make_table() {
  Descriptors all;
  for (const std::string& scene : synthetic_scenes())
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) describe(scene, seed, all);
  places::PlaceWords table;
  table.mean = all.rowwise().mean();
  all.colwise() -= table.mean;
  const Eigen::MatrixXd spread = (all * all.transpose()).cast<double>() / static_cast<double>(all.cols());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(spread);
  for (int k = 0; k < kWordNumbers; ++k) {
    const Eigen::Index axis = kWideBytes - 1 - k;  // the largest come last
    const auto variance = static_cast<float>(axes.eigenvalues()[axis]);
    table.projection.row(k) = axes.eigenvectors().col(axis).transpose().cast<float>() / std::pow(variance, kWhitening);
  }
  const Projected projected = table.projection * all;
  std::mt19937 random(0);
  for (int word = 0; word < kWords; ++word)
    table.words.col(word) = projected.col(static_cast<Eigen::Index>(random() % static_cast<unsigned>(all.cols())));
  improve(projected, table.words);
  write(table.mean);
  write(table.projection);
  write(table.words);
}

}  // namespace

int main() {
  try {
    make_table();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "place_words: %s\n", error.what());
    return 1;
  }
}
