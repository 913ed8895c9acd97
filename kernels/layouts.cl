// layouts.cl: memory layouts shared by host and kernels, prepended to every program after common.cl. The host compiles
// this file, too (host/tracker/common/layouts.hpp), so it must be valid C and C++. It also defines the constants named
// kLikeThis.
//
// Structures are passed to kernels by value. Their fields are int, float, arrays or structures of these: all of 4
// bytes, so that no compiler inserts padding. tests/test_layouts.cpp compares their fields on every device.

// STRUCTURE(NAME) {...}; defines a structure, of which the host also gets the name as that of an argument's type.
#ifdef __cplusplus
#define FLOAT_CONSTANT constexpr float
#define STRUCTURE(NAME)                                              \
  struct NAME;                                                       \
  constexpr const char* argument_type(const NAME*) { return #NAME; } \
  struct NAME
#else
#define FLOAT_CONSTANT constant float
#define STRUCTURE(NAME)     \
  typedef struct NAME NAME; \
  struct NAME
#endif

// Side patches of an edge (patches.cl): rows of 16 bytes, 8 of the dark and 8 of the bright patch, the last of each
// zero; then 1 / norm of both patches as floats, and zeros up to 16 bytes. Rows lie along the edge, where the image
// changes less than across it: five of them, kPatchRowStep apart, show as much of a curve as seven would 1 px apart.
enum {
  kPatchSide = 7,                                // samples across the edge, 1 px apart
  kPatchRows = 5,                                // rows along it
  kPatchSamples = kPatchSide * kPatchRows,       // of one patch
  kPatchLanes = kPatchSide + 1,                  // bytes of one row of a patch; work-items that share a patch
  kInverseNorms = 2 * kPatchLanes * kPatchRows,  // where they begin
  kEdgePatchBytes = kInverseNorms + 16,          // both patches of an edge
  kPatchItems = 2 * kPatchLanes,                 // work-items that share an edge
  kPatchLargest = 127                            // magnitude of the largest sample
};
FLOAT_CONSTANT kPatchRowStep = 1.5f;        // px
FLOAT_CONSTANT kFlatPatchContrast = 1e-5f;  // grey levels: a patch that stays as close to its mean is flat

// Side patches of the paper's method (paper_patches.cl), 7 x 7 samples 1 px apart: seven rows along the edge of 16
// floats, mean-free grey levels, lanes 0 to 6 across the dark side, 8 to 14 across the bright one, 7 and 15 zero; then
// 1 / norm of the dark and of the bright patch, 0 where it is flat, and zeros up to 16 floats.
enum {
  kPaperPatchRows = 7,
  kPaperInverseNorms = 16 * kPaperPatchRows,  // where they begin, in floats
  kPaperPatchFloats = kPaperInverseNorms + 16
};

// SIFT descriptors of an edge (sift.cl): dark side, then bright side; bytes [cell across][cell along][angle].
enum {
  kSiftCells = 4,                            // spatial bins along each axis
  kSiftAngles = 8,                           // orientation bins
  kSiftItems = 2 * kSiftCells * kSiftCells,  // work-items that share an edge
  kSiftBytes = kSiftCells * kSiftCells * kSiftAngles,
  kEdgeSiftBytes = 2 * kSiftBytes,
  kSiftPadding = 16  // of the gradient's maps, px
};

// Wide descriptor of a stereo edge (wide_description.cl): bytes [cell across][cell along][angle].
enum {
  kWideShrink = 3,  // pixels of the image per small pixel, each way
  kWideCells = 4,   // spatial bins along each axis
  kWideAngles = 8,  // orientation bins
  kWideBytes = kWideCells * kWideCells * kWideAngles
};

// Wide descriptors that are interleaved in a block, element by element (global_matching.cl).
enum { kBlockLanes = 16 };

// Cells of a point index (point_index.cl), px.
FLOAT_CONSTANT kCellWidth = 8.0f;
FLOAT_CONSTANT kCellHeight = 4.0f;

// State of a candidate, one byte: alive, rejected by the filter of that order (1 to 254), or represented by another
// candidate at the same position, which is refined for both.
enum { kCandidateAlive = 0, kCandidateRepresented = 255 };

// Candidates within this distance [px] after the shift onto the epipolar line count as one position: they are
// neighbours on a curve that the refinement moves to the same point (stereo_refinement.cl).
FLOAT_CONSTANT kSamePosition = 0.5f;
FLOAT_CONSTANT kLongestScaleDrift = 3.0f;  // of an edge per unit of log(edges.sigma) [px]; flat profiles promise any
// Largest ratio of contrasts that the photometric alignment compensates (photometric.cl).
FLOAT_CONSTANT kGainMax = 2.0f;
// Members of a cluster whose similarity differs by less are equally similar: the first right edge in scan order
// represents the cluster. Members that the refinement led to the same position always are; rounding must not choose
// between them (stereo_clusters.cl).
FLOAT_CONSTANT kSimilarityTie = 1e-4f;
// Distances of the members from the centre of a cluster of the paper's method are compared in steps of so many px
// (paper_clusters.cl).
FLOAT_CONSTANT kClusterDistanceStep = 1.0f / 64.0f;
// What a represented member of a cluster falls behind: more than two similarities can differ, so that it represents a
// cluster only where no member is alive, and no limit of similarity lets that cluster pass.
FLOAT_CONSTANT kBehindAll = 3.0f;

// Positions of edges packed in one buffer of floats: of edge i, x [px] stands at first + i, y at first + stride + i and
// direction [rad] at first + 2 stride + i.
STRUCTURE(PackedPositions) { int first, stride, count; };

// A point index (point_index.cl): its points in the order of the index, and its cells.
STRUCTURE(PackedPointIndex) {
  PackedPositions points;
  int columns, rows;  // cells
};

// The rig and the limits of the search in single precision, as kernels and reference use them.
//
// A left pixel p seen at depth Z projects to h + t / Z (homogeneous), h = K_R R0 K_L^-1 (p, 1), t = K_R T0: its
// epipolar line starts at the point of infinite depth and runs towards nearer points. Positions on the line are
// measured by s, pixels from the point at infinity; on a rectified rig s is the disparity.
STRUCTURE(EpipolarGeometry) {
  float h[9];               // K_R R0 K_L^-1, row-major; rolled by the rectification error that the search follows
  float t[3];               // K_R T0
  float across[6];          // that error: px towards (ey, -ex) for 1, x, y, xx, xy, yy of the right pixel
  float epipole[3];         // left epipole, homogeneous: the left line through p runs along epipole.xy - epipole.z p
  float inverse_min_depth;  // 1/m; 0 where max_disparity limits the search
  float max_disparity;      // px
  float tolerance;          // beyond either end of the segment, px
  float epipolar_distance;  // px
  float orientation;        // rad, modulo half a turn
  float min_epipolar_sine;  // sine of the smallest angle between an edge and its left epipolar line
};

// Gauss-Newton on the position of a patch (photometric.cl).
STRUCTURE(AlignmentSettings) {
  int steps;
  float tolerance;  // px
  float huber;      // grey levels
  float clamp;      // px
};

// Tallies of edge_threshold.cl.
enum {
  kThresholdStep = 8,                      // between points of the lattice, px
  kGradientBins = 192,                     // eight per octave, from 2^-12 to 2^12 grey levels per px
  kGradientBinsFrom = (127 - 12) * 8 - 1,  // what a float's upper 12 bits exceed the bin by; bin 0 holds all below
  kNoiseBins = 152,                        // of 0 to 2^21 steps
  kThresholdBins = kGradientBins + kNoiseBins
};
// Median of the noise operator's magnitude for normal noise of standard deviation 1: its norm, 6, times the normal
// distribution's 75 % quantile.
FLOAT_CONSTANT kNoiseMedian = 4.04693850f;
// Factor by which the threshold in use and the measured one may differ.
FLOAT_CONSTANT kThresholdHold = 1.25f;

// edge_threshold.cl. Thresholds in grey levels per px.
STRUCTURE(ThresholdArguments) {
  int width, height;      // of the image
  int plane_stride;       // floats per row of the padded image
  float max_grey;         // grey level at which the camera saturates
  float quantum;          // grey levels between neighbouring values of the recorded image
  float area;             // ratio of the image whose gradient shall exceed the threshold
  float per_noise;        // threshold per grey level of the noise's standard deviation
  float lowest, highest;  // highest wins
};

// Scratch memory of edge_detection_strip.cl and grid_edges.cl: lines per work-item, and floats of a line in front of
// the first pixel.
enum { kStripLines = 11, kGridLines = 26, kStripLineFront = 16 };

// edge_detection_strip.cl, edge_detection_tile.cl and grid_edges.cl. Edges are packed in blocks of max_edges floats: x,
// y, direction, strength, scale-space shift.
STRUCTURE(DetectionArguments) {
  int width, height;  // of the image
  int plane_stride;   // floats per row of the padded image
  int margin;         // px
  float newton_max;   // px
  int max_edges;
};

// Numbers the epipolar lines in the same way in both images of a rig, in pixels of the left camera: the line through
// (x, y) has number (across . (x, y, 1)) / (forward . (x, y, 1)) - bend . (xx, xy, yy). On a rectified rig that is y
// less the principal point's.
STRUCTURE(EpipolarRows) {
  float across_x, across_y, across_1;
  float forward_x, forward_y, forward_1;
  float bend_xx, bend_xy, bend_yy;
};

enum {
  kSelectionUnit = 256,  // of the weights that edge_selection.cl adds up
  kSelectionSample = 4,  // one of so many rows is weighed
  kMaximaAtOnce = 16     // of a row that the selection tests together
};
FLOAT_CONSTANT kSearchedWidth = 1.25f;    // of the maxima around a line that the searched image keeps, in steps
FLOAT_CONSTANT kSelectionSteps = 32.0f;   // of the spacing per px: a maximum more or less does not change it
FLOAT_CONSTANT kClosestSelection = 1.0f;  // px; maxima of a curve are hardly closer
FLOAT_CONSTANT kDenseBudget = 1.75f;      // times the budget has an image in which edges would be too far apart

// edge_selection.cl.
STRUCTURE(SelectionArguments) {
  int width, height;  // of the image
  EpipolarRows rows;
  float min_sine;  // of the angle between an edge and its epipolar line: what lies flatter cannot be matched
  float slack;     // by which that sine may differ between the images; 1: no difference is allowed for
};

// patches.cl.
STRUCTURE(PatchArguments) {
  int width, height;
  float offset;  // px from the edge to the middle of a patch
  int all;       // 0: only the edges that are wanted
  PackedPositions edges;
};

// sift.cl.
STRUCTURE(SiftArguments) {
  int width, height;
  int stride;    // floats per row of the maps
  float offset;  // px from the edge to the middle of a descriptor
  PackedPositions edges;
};

// Left edges that search beyond the range of the others: those whose number is a multiple of `step`.
STRUCTURE(DisparityProbe) {
  int step;             // 0: none
  float max_disparity;  // of these edges, px
};

// stereo_candidates.cl: candidates per row that the first sweep can note.
enum { kNotedCandidates = 32 };
STRUCTURE(StereoCandidateArguments) {
  PackedPositions left, right;
  int right_height;  // px
  EpipolarGeometry geometry;
  DisparityProbe probe;
};

// Thresholds of doc/method.md section 3 filters 4 to 7, or section 4 filters 3 to 6. The orders are the filters'
// numbers in their cascade; the nearly-best filters follow at the larger one + 1 and + 2. sift_max = 0: SIFT is
// not used.
STRUCTURE(FilterLimits) {
  float ncc_min, sift_max, ncc_nearly_best, sift_nearly_best;
  int ncc_order, sift_order;
};

// candidate_filters.cl.
STRUCTURE(FilterArguments) {
  int rows;
  int row_step;    // row r belongs to edge r * row_step of the first set
  int capacity;    // of the candidate lists
  int all_scores;  // not 0: both scores of every candidate, even where one decides
  FilterLimits limits;
};

// stereo_refinement.cl and stereo_refinement_lanes.cl.
STRUCTURE(StereoRefinementArguments) {
  PackedPositions left, right;
  int capacity;  // of the candidate lists
  int left_width, left_height, right_width, right_height;
  float patch_offset;               // px from an edge to its side patches
  float shift_min_sine, shift_max;  // of the shift onto the line
  float stiffness;                  // of the prior across the edge, grey levels^2 / px^2
  AlignmentSettings alignment;
  float similarity_min;
  int rejected_order;
  EpipolarGeometry geometry;
};

// stereo_clusters.cl. Clusters are packed in blocks of `capacity` floats: position, direction, similarity.
STRUCTURE(StereoClusterArguments) {
  PackedPositions left, right;
  int capacity;  // of the candidate lists
  float cluster_gap;
  float cluster_orientation;  // rad
  int cluster_size_max;
  float cluster_sigma;
};

// paper_refinement.cl. Settings as in AlignmentSettings. `fixed` are the edges of the rows, `moving` their candidates.
STRUCTURE(PaperRefinementArguments) {
  PackedPositions fixed, moving;
  int capacity;  // of the candidate lists
  int fixed_width, fixed_height, moving_width, moving_height;
  float offset;  // px from an edge to the middle of its patches
  int steps;
  float tolerance;                  // px
  float huber;                      // grey levels
  int both_sides;                   // 0: only the most similar pair of sides
  float shift_min_sine, shift_max;  // of the shift onto the line
  float largest_residual;           // rms that a free move may leave [grey levels]
  EpipolarGeometry geometry;        // for a move along a line
};

// paper_clusters.cl. Refined positions are packed in blocks of `candidates` floats: x, y; clusters in blocks of
// `capacity`: x, y, direction of the centre, similarity; the first member and the number of members likewise, in ints.
STRUCTURE(PaperClusterArguments) {
  PackedPositions moving;  // the candidates
  int rows;
  int candidates;     // capacity of the candidate lists
  int capacity;       // of the clusters: alive candidates
  float gap;          // px
  float orientation;  // rad
  int size_max;
  float sigma;  // px
};

// paper_quads.cl. The clusters of either image are in blocks of that capacity, the quads in blocks of `capacity`.
STRUCTURE(PaperQuadArguments) { int rows, left_capacity, right_capacity, capacity; };

// paper_clusters.cl: paper_similarity().
STRUCTURE(PaperSimilarityArguments) {
  int rows, capacity;  // of the clusters
  int width, height;   // of their image
  float offset;        // px from an edge to the middle of its patches
  float ncc_min;       // of the chosen cluster
};

// coarse_disparity.cl.
enum {
  kCoarseLanes = 16,        // levels of a vector
  kCoarseMostLevels = 256,  // of disparity
  kCoarseSlope = 30,        // steepest slope along a row that is distinguished
  kCoarsePlanes = 6         // per pixel: slope, its bounds half-way to either neighbour, grey level, its bounds
};
FLOAT_CONSTANT kNoCoarseDisparity = -1e9f;  // px, where it is not known
STRUCTURE(CoarseDisparityArguments) {
  int width, height;               // of the half-size left image; that of the right one is as high
  int right_width;                 // of the half-size right image
  int levels;                      // disparities of two px of the images, a multiple of kCoarseLanes
  int shift;                       // at level d the counterpart of column x is x + shift - d
  int right_front, right_stride;   // a row of a plane of the mirrored right image: places in front of it, and all
  int right_first;                 // place of the counterpart of column 0 at level 0
  int step_penalty, jump_penalty;  // of a path, for a change by one level and for any other
  float first;                     // position on the epipolar line at level 0, px of the images
};

// stereo_relaxation.cl. Neighbours are found by cells of this size [px], of which each shows one edge: about the
// distance of the points of a ring from one another, so that they find different edges.
FLOAT_CONSTANT kRelaxationCell = 4.0f;
// Eight points on each of two rings around an edge, px: what lies nearer than the first one shares the edge's patches
// and their mistake; the second one carries agreement across a repeated texture in a few rounds.
enum { kRelaxationNeighbours = 16 };
FLOAT_CONSTANT kRelaxationRing[2] = {6.0f, 20.0f};
FLOAT_CONSTANT kEighthCosine[8] = {1.0f, 0.70710678f, 0.0f, -0.70710678f, -1.0f, -0.70710678f, 0.0f, 0.70710678f};
// Two positions support each other if they differ by less than this [px], for each ring: 1 px, plus 0.2 px per px of
// distance between the edges, for surfaces of unknown slope.
FLOAT_CONSTANT kSupportReach[2] = {2.2f, 5.0f};
// Support of an edge without neighbours that agree: neighbours alone must not rule out a candidate.
FLOAT_CONSTANT kSupportFloor = 0.05f;
// Support assigned to an edge whose only candidate is similar enough without a vote: that of an average edge.
FLOAT_CONSTANT kUsualSupport = 0.7f;
// Steepest change of a position along an edge that is believed, and the sine of the smallest angle between a right edge
// and its epipolar line at which it is taken: below it the angle's error is the slope.
FLOAT_CONSTANT kSlopeMax = 0.5f;
FLOAT_CONSTANT kSlopeMinSine = 0.2f;
STRUCTURE(StereoRelaxationArguments) {
  PackedPositions left;
  int capacity;            // of the candidate lists
  int columns, cell_rows;  // cells of the left image
  float similarity_min;    // of a candidate that takes part
  float scale;             // of differences of similarity
  float support_weight;    // in similarity; 0: no vote
  float score_min;         // of the chosen candidate
  float undecided;         // belief below which an edge counts as undecided
  int coarse_columns, coarse_rows;
  float coarse_reach;    // px along the epipolar line within which a coarse position speaks for a candidate
  float coarse_dissent;  // how likely it leaves the edge's other candidates
  EpipolarGeometry geometry;
};

// stereo_mutual.cl.
STRUCTURE(StereoMutualArguments) {
  PackedPositions left;
  int capacity;  // of the candidate lists
  float mutual_radius;
  EpipolarGeometry geometry;
};

// point_index.cl.
STRUCTURE(PointIndexArguments) {
  PackedPositions left_edges, right_edges;
  PackedPointIndex left, right;
};

// temporal_candidates.cl.
STRUCTURE(TemporalCandidateArguments) {
  int rows;
  int row_step;  // row r belongs to base edge r * row_step
  PackedPositions predicted;
  PackedPointIndex index;
  float radius;       // px
  float orientation;  // rad
};

// What makes the quad of a row (doc/method.md section 4, filter 8).
STRUCTURE(QuadChoice) {
  float distance_weight;      // what a squared px from the predicted left position takes from the score
  float cluster_gap;          // px
  float cluster_orientation;  // rad
};

// A row of temporal_match.cl and temporal_quads.cl, ints: current edge or -1, competing clusters, score as bits, flags.
enum {
  kQuadRowInts = 4,
  kLeftAlive = 1,   // flag: the left list kept a candidate before the agreement
  kRightAlive = 2,  // flag: so did the right one
  kRowOverflow = 4  // flag: more candidates than there is room for; the row has no result
};

// temporal_match.cl.
STRUCTURE(TemporalMatchArguments) {
  int rows;
  int row_step;  // row r belongs to base edge r * row_step
  PackedPositions left_predicted, right_predicted;
  PackedPointIndex left_index, right_index;
  PackedPositions current;  // of the left image
  float radius;             // px
  float orientation;        // rad
  float ncc_min, ncc_nearly_best;
  QuadChoice choice;
};

// temporal_quads.cl: temporal_agreement().
STRUCTURE(TemporalAgreementArguments) {
  int rows;
  int left_capacity, right_capacity;  // of the candidate lists
  int rejected_order;
};

// temporal_quads.cl: temporal_best().
STRUCTURE(TemporalBestArguments) {
  int rows;
  int row_step;                        // row r belongs to base edge r * row_step
  int capacity;                        // of the candidate lists
  PackedPositions predicted, current;  // of the left image
  QuadChoice choice;
};

// global_matching.cl: edges packed in blocks of `stride` floats (left x, left y ...), of
// which every step-th takes part.
STRUCTURE(WideSelection) { int stride, count, step; };
STRUCTURE(GlobalMatchingArguments) {
  WideSelection rows, columns;
  float neighbourhood;  // px
  float ratio;
};
