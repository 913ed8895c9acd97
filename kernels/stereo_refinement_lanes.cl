// stereo_refinement_lanes.cl: stereo_refinement.cl with eight work-items per left edge, for GPUs.
//
// Needs direction.cl, epipolar.cl, photometric.cl, photometric_lanes.cl and candidate_positions.cl. In and out as
// there, and the same bits: a work-item is one lane across the edge, its patches are columns in private memory, sums
// over lanes go through local memory.
// Groups of GROUP work-items refine one candidate of each of their edges at a time; the first lane of an edge keeps its
// row of candidates. Local memory: EXCHANGE_FLOATS floats.
// Reference: host/reference/stereo_refinement.cpp.

// NCC of a side patch of the left edge, columns of 16 bytes apart, and the patch at `frame` of the right image.
static inline float side_ncc(global const uint* corners, const int width, const int height, const PatchFrame frame,
                             global const char* side_patch, const float inverse_norm, const int wanted,
                             Exchange* exchange) {
  float column[kPatchSide] = {0.0f}, own[kPatchSide];
  cut_column(corners, width, height, frame, wanted, exchange, column);
#pragma unroll
  for (int i = 0; i < kPatchSide; ++i) own[i] = (float)side_patch[16 * i + lane_of_item()];
  const float2 sums = sum_two_lanes(exchange, column_product(column, column), column_product(column, own));
  const float norm = sqrt(sums.x);
  return norm < 1e-10f ? 0.0f : sums.y * inverse_norm / norm;
}

// LONG: a row from shift to similarity; its patches stay in private memory.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void stereo_refinement(
    const StereoRefinementArguments args, global const int* first, global const int* target, global const float* ncc,
    global const uint* left_corners, global const uint* right_corners, global const char* left_patches,
    global const float* left_edges, global const float* right_edges, global uchar* state, global float* position,
    global float* similarity) {
  local float memory[EXCHANGE_FLOATS];
  Exchange exchange = {memory, 0};
  const int lane = lane_of_item(), first_item = kPatchLanes * patch_in_group();
  // Surplus work-items work along with the last edge and an empty row for the barriers.
  const int wanted = (int)(get_global_id(0) / kPatchLanes), left_count = args.left.count;
  const int i = min(wanted, left_count - 1);
  const int begin = wanted < left_count ? first[i] : 0,
            end = wanted < left_count ? min(first[i + 1], args.capacity) : 0;
  global const float* left_x = left_edges + args.left.first;
  global const float* left_y = left_x + args.left.stride;
  global const float* left_direction = left_y + args.left.stride;
  global const float* right_x = right_edges + args.right.first;
  global const float* right_y = right_x + args.right.stride;
  global const float* right_direction = right_y + args.right.stride;
  const float x = left_x[i], y = left_y[i];
  const EpipolarLine line = epipolar_line(&args.geometry, x, y);
  // A position known across the edge is known the worse along the line the flatter the edge lies to it.
  const float line_sine = left_epipolar_sine(&args.geometry, x, y, left_direction[i]);
  const float edge_stiffness = args.stiffness * line_sine * line_sine;
  float cosine;
  const float sine = sine_cosine(left_direction[i], &cosine);
  global const char* side_patches = left_patches + (size_t)i * kEdgePatchBytes;
  const float2 inverse_norms = vload2(0, (global const float*)(side_patches + kInverseNorms));

  for (int c = begin + lane; c < end; c += kPatchLanes) {
    const int j = target[c];
    if (state[c] == kCandidateAlive)
      position[c] =
          epipolar_shift(line, right_x[j], right_y[j], right_direction[j], args.shift_min_sine, args.shift_max);
  }
  barrier(CLK_GLOBAL_MEM_FENCE);
  // From here on only the first lane reads and writes the row.
  const int keeper = lane == 0;
  if (keeper) {
    for (int c = begin; c < end; ++c) {
      if (state[c] == kCandidateAlive) choose_representative(begin, c, ncc, position, state);
    }
  }

  float fixed[kPatchSide] = {0.0f}, derivative[kPatchSide] = {0.0f}, values[kPatchSide] = {0.0f};
  float fixed_norm = 0.0f;
  int ready = 0;
  for (int c = begin;; ++c) {
    if (keeper) {
      while (c < end && state[c] != kCandidateAlive) ++c;
    }
    const int found = keeper && c < end;
    local const float* told = tell(&exchange, found ? 1.0f : 0.0f, found ? position[c] : 0.0f);
    const int living = told[first_item] != 0.0f;
    float s = told[GROUP + first_item];
    if (!any_patch(told)) break;
    if (!ready) {  // an edge without a candidate now has none later
      const PatchFrame frame = patch_frame(x, y, cosine, sine, 0.0f, 0.0f);
      cut_column(left_corners, args.left_width, args.left_height, frame, living, &exchange, fixed);
      derivative_column(left_corners, args.left_width, args.left_height, frame, line.ex, line.ey, living, &exchange,
                        derivative);
      fixed_norm = sqrt(sum_lanes(&exchange, column_product(fixed, fixed)));
      ready = 1;
    }
    // Patches are cut with the left direction in both images.
    const PatchFrame moving = patch_frame(line.x + s * line.ex, line.y + s * line.ey, cosine, sine, 0.0f, 0.0f);
    float move = 0.0f;
    const int aligned =
        align_columns(right_corners, args.right_width, args.right_height, moving, line.ex, line.ey, fixed, fixed_norm,
                      derivative, edge_stiffness, args.alignment, living, &exchange, values, &move);
    s += move;
    const float right_x_now = line.x + s * line.ex, right_y_now = line.y + s * line.ey;
    cut_column(right_corners, args.right_width, args.right_height,
               patch_frame(right_x_now, right_y_now, cosine, sine, 0.0f, 0.0f), aligned == ALIGN_MOVED, &exchange,
               values);
    const float2 sums = sum_two_lanes(&exchange, column_product(values, values), column_product(fixed, values));
    const float norms = fixed_norm * sqrt(sums.x);
    const float on_edge = norms < 1e-10f ? 0.0f : sums.y / norms;
    // No side can make up for a centre that is too unlike: it counts as unlike as a side can be.
    const int alike = aligned != ALIGN_LEFT && 0.5f * (on_edge + 1.0f) >= args.similarity_min;
    const float dark = side_ncc(right_corners, args.right_width, args.right_height,
                                patch_frame(right_x_now, right_y_now, cosine, sine, 1.0f, args.patch_offset),
                                side_patches, inverse_norms.x, alike, &exchange);
    const float bright = side_ncc(right_corners, args.right_width, args.right_height,
                                  patch_frame(right_x_now, right_y_now, cosine, sine, -1.0f, args.patch_offset),
                                  side_patches + kPatchLanes, inverse_norms.y, alike, &exchange);
    if (!found) continue;
    if (aligned == ALIGN_LEFT) {
      state[c] = (uchar)args.rejected_order;
    } else {
      position[c] = s;
      similarity[c] = 0.5f * (on_edge + (alike ? fmax(dark, bright) : -1.0f));
    }
  }
  if (keeper) follow_representatives(begin, end, args.rejected_order, position, state, similarity);
}
