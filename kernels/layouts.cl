// layouts.cl: put in front of every program, behind common.cl. What host and kernels have to lay out alike, written once: the host
// compiles this very file (host/common/layouts.hpp), so it keeps to what is C and C++ at once. Constants named kLikeThis stand here.
//
// Structures are passed to kernels by value. Their fields are int, float, arrays or structures of these: all of 4 bytes, so that no
// compiler puts room between them. tests/test_layouts.cpp compares them on every device, field by field.

#ifdef __OPENCL_VERSION__
#define FLOAT_CONSTANT constant float
#else
#define FLOAT_CONSTANT constexpr float
#endif

// Side patches of an edge (patches.cl): seven rows of 16 bytes, 8 of the dark and 8 of the bright patch, the last of each zero; then
// 1 / norm of both patches as floats.
enum {
  kPatchSide = 7,                                // samples along each axis
  kPatchSamples = kPatchSide * kPatchSide,       // of one patch
  kPatchLanes = kPatchSide + 1,                  // bytes of one row of a patch
  kEdgePatchBytes = 128,                         // both patches of an edge
  kInverseNorms = 2 * kPatchLanes * kPatchSide,  // where they begin
  kPatchLargest = 127                            // magnitude of the largest sample
};
FLOAT_CONSTANT kFlatPatchContrast = 1e-5f;  // grey levels: a patch that stays as close to its mean is flat

// SIFT descriptors of an edge (sift.cl): dark side, then bright side; bytes [cell across][cell along][angle].
enum {
  kSiftCells = 4,   // spatial bins along each axis
  kSiftAngles = 8,  // orientation bins
  kSiftBytes = kSiftCells * kSiftCells * kSiftAngles,
  kEdgeSiftBytes = 2 * kSiftBytes
};

// Wide descriptor of a stereo edge (wide_description.cl): bytes [cell across][cell along][angle].
enum {
  kWideShrink = 3,  // pixels of the image per small pixel, each way
  kWideCells = 4,   // spatial bins along each axis
  kWideAngles = 8,  // orientation bins
  kWideBytes = kWideCells * kWideCells * kWideAngles
};

// Cells of a point index (point_index.cl), px.
FLOAT_CONSTANT kCellWidth = 8.0f;
FLOAT_CONSTANT kCellHeight = 4.0f;

// State of a candidate, one byte: alive, rejected by the filter of that order (1 to 254), or represented by another candidate at the same
// position, which is refined for both.
enum { kCandidateAlive = 0, kCandidateRepresented = 255 };

// Candidates that shift onto the epipolar line within so many px of one another lie at the same position: neighbours on a curve, which
// the refinement leads to the same point (stereo_refinement.cl).
FLOAT_CONSTANT kSamePosition = 0.5f;
// Largest difference of contrast that the photometric alignment evens out (photometric.cl).
FLOAT_CONSTANT kGainMax = 2.0f;
// Members of a cluster whose similarity differs by less are equally similar: the first right edge in scan order represents the cluster.
// Members that the refinement led to the same position always are; rounding must not choose between them (stereo_clusters.cl).
FLOAT_CONSTANT kSimilarityTie = 1e-4f;
// What a represented member of a cluster falls behind: more than two similarities can differ, so that it represents a cluster only
// where no member is alive, and no limit of similarity lets that cluster pass.
FLOAT_CONSTANT kBehindAll = 3.0f;

// Thresholds of doc/method.md section 3 filters 4 to 7, or section 4 filters 3 to 6. The orders are the filters' numbers in their
// cascade; the nearly-best filters follow at the larger one + 1 and + 2. sift_max = 0: SIFT takes no part.
typedef struct {
  float ncc_min, sift_max, ncc_nearly_best, sift_nearly_best;
  int ncc_order, sift_order;
} FilterLimits;

// candidate_filters.cl.
typedef struct {
  int rows;
  int row_step;    // row r belongs to edge r * row_step of the first set
  int capacity;    // of the candidate lists
  int all_scores;  // not 0: both similarities of every candidate, also where one decides
  FilterLimits limits;
} FilterArguments;
