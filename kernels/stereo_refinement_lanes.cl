// stereo_refinement_lanes.cl: stereo_refinement.cl with eight work-items per left edge, for GPUs.
//
// Needs direction.cl, epipolar.cl, photometric.cl, photometric_lanes.cl and candidate_positions.cl. In and out as
// there, and the same bits: a work-item is one lane across the edge and holds its column of every patch, sums over
// lanes go through local memory.
// Groups of GROUP work-items refine one candidate of each of their edges at a time; the first lane of an edge keeps its
// row of candidates. Local memory: EXCHANGE_FLOATS + 2 kPatchRows GROUP floats.
// Reference: host/workbench/reference/stereo_matching.cpp.

// LONG: a row from shift to similarity; the left edge's patches stay in local memory.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void stereo_refinement(
    const StereoRefinementArguments args, global const int* first, global const int* target, global const float* ncc,
    global const uint* left_corners, global const uint* right_corners, global const char* left_patches,
    global const float* left_edges, global const float* right_edges, global uchar* state, global float* position,
    global float* similarity) {
  local float memory[EXCHANGE_FLOATS];
  Exchange exchange = {memory, 0};
  // Values that all candidates of an edge use, one column per work-item; in local memory, to save registers.
  local float fixed_columns[kPatchRows * GROUP], derivative_columns[kPatchRows * GROUP];
  local float* fixed = fixed_columns + get_local_id(0);
  local float* derivative = derivative_columns + get_local_id(0);
  const int lane = lane_of_item(), first_item = kPatchLanes * patch_in_group();
  // Surplus work-items take the last edge and an empty row, since all must reach the barriers.
  const int wanted = (int)(get_global_id(0) / kPatchLanes), left_count = args.left.count;
  const int i = min(wanted, left_count - 1);
  const int begin = wanted < left_count ? first[i] : 0,
            end = wanted < left_count ? min(first[i + 1], args.capacity) : 0;
  RefinedEdge edge;
  open_edge(&args, left_edges, i, &edge);
  const EpipolarLine line = edge.line;
  global const char* side_patches = left_patches + (size_t)i * kEdgePatchBytes;
  const float2 inverse_norms = *(global const float2*)(side_patches + kInverseNorms);

  for (int c = begin + lane; c < end; c += kPatchLanes) {
    if (state[c] == kCandidateAlive) position[c] = epipolar_shift(&args, &line, right_edges, target[c]);
  }
  barrier(CLK_GLOBAL_MEM_FENCE);
  // From here on only the first lane reads and writes the row.
  const int keeper = lane == 0;
  int alive = 0;
  if (keeper) {
    for (int c = begin; c < end; ++c) {
      if (state[c] != kCandidateAlive) continue;
      choose_representative(begin, c, ncc, position, state);
      alive = 1;
    }
  }
  const int has_candidates = tell(&exchange, alive ? 1.0f : 0.0f, 0.0f)[first_item] != 0.0f;

  // The left edge's patch and its derivative, the difference of two patches.
  float values[kPatchRows] = {0.0f}, fixed_norm = 0.0f;
#pragma unroll 1  // one copy of cut_column(): registers
  for (int part = 0; part < 3; ++part) {
    const float ahead = part == 0 ? 0.0f : part == 1 ? 0.5f : -0.5f;
    const PatchFrame frame =
        patch_frame(edge.x + ahead * line.ex, edge.y + ahead * line.ey, edge.cosine, edge.sine, 0.0f, 0.0f);
    cut_column(left_corners, args.left_width, args.left_height, frame, has_candidates, &exchange, values);
    const float norm = sqrt(sum_lanes(&exchange, column_product(values, values)));
    fixed_norm = part == 0 ? norm : fixed_norm;
    local float* column = part == 0 ? fixed : derivative;
#pragma unroll
    for (int k = 0; k < kPatchRows; ++k) column[GROUP * k] = part < 2 ? values[k] : column[GROUP * k] - values[k];
  }
  for (int c = begin;; ++c) {
    if (keeper) {
      while (c < end && state[c] != kCandidateAlive) ++c;
    }
    const int found = keeper && c < end;
    local const float* told = tell(&exchange, found ? 1.0f : 0.0f, found ? position[c] : 0.0f);
    const int living = told[first_item] != 0.0f;
    float s = told[GROUP + first_item];
    if (!any_patch(told)) break;
    // Patches are cut with the left direction in both images.
    const PatchFrame moving =
        patch_frame(line.x + s * line.ex, line.y + s * line.ey, edge.cosine, edge.sine, 0.0f, 0.0f);
    float move = 0.0f;
    const int aligned =
        align_columns(right_corners, args.right_width, args.right_height, moving, line.ex, line.ey, fixed, fixed_norm,
                      derivative, edge.stiffness, args.alignment, living, &exchange, values, &move);
    s += move;
    const float right_x_now = line.x + s * line.ex, right_y_now = line.y + s * line.ey;
    // On the edge, then on its dark and on its bright side.
    float on_edge = 0.0f, beside = -1.0f;
    int alike = aligned == ALIGN_MOVED;
#pragma unroll 1  // one copy of cut_column(): registers
    for (int place = 0; place < 3; ++place) {
      const float side = place == 0 ? 0.0f : place == 1 ? 1.0f : -1.0f;
      cut_column(right_corners, args.right_width, args.right_height,
                 patch_frame(right_x_now, right_y_now, edge.cosine, edge.sine, side, args.patch_offset), alike,
                 &exchange, values);
      float own[kPatchRows];
#pragma unroll
      for (int k = 0; k < kPatchRows; ++k)
        own[k] = place == 0 ? fixed[GROUP * k] : (float)side_patches[16 * k + (place == 1 ? 0 : kPatchLanes) + lane];
      const float2 sums = sum_two_lanes(&exchange, column_product(values, values), column_product(own, values));
      const float norm = sqrt(sums.x);
      if (place == 0) {
        const float norms = fixed_norm * norm;
        on_edge = norms < 1e-10f ? 0.0f : sums.y / norms;
        // A similar side cannot compensate for a dissimilar centre, which gets the lowest similarity of a side.
        alike = aligned != ALIGN_LEFT && 0.5f * (on_edge + 1.0f) >= args.similarity_min;
      } else if (alike) {
        const float side_ncc = norm < 1e-10f ? 0.0f : sums.y * (place == 1 ? inverse_norms.x : inverse_norms.y) / norm;
        beside = place == 1 ? side_ncc : fmax(beside, side_ncc);
      }
    }
    if (!found) continue;
    if (aligned == ALIGN_LEFT) {
      state[c] = (uchar)args.rejected_order;
    } else {
      position[c] = s;
      similarity[c] = 0.5f * (on_edge + beside);
    }
  }
  if (keeper) follow_representatives(begin, end, args.rejected_order, position, state, similarity);
}
