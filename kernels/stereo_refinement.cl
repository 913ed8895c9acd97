// stereo_refinement.cl: filter 8a and 8b of the stereo cascade: epipolar shift, then photometric refinement along the
// line.
//
// Needs direction.cl, epipolar.cl, photometric.cl and candidate_positions.cl. In: both images as corners, edges, the
// left edges' side patches (patches.cl), candidate lists.
// Out per candidate: its position `s` on the left edge's epipolar line (px from the point at infinity), the similarity
// of both positions, and state = rejected_order where the refinement diverged. One work-item = one left edge;
// stereo_refinement_lanes.cl has eight per edge.
// Reference: host/workbench/reference/stereo_matching.cpp.

// The higher NCC of the two side patches of a left edge and those cut at two positions of the right image.
static inline float better_side(global const uint* corners, const int width, const int height, const PatchFrame dark,
                                const PatchFrame bright, global const char* side_patches) {
  float16 rows[kPatchRows], squares = 0.0f, products = 0.0f;
  cut_two_patches(corners, width, height, dark, bright, rows);
  for (int k = 0; k < kPatchRows; ++k) {
    squares += rows[k] * rows[k];
    products += rows[k] * convert_float16(((global const char16*)side_patches)[k]);
  }
  const float dark_norm = sqrt(sum_used(squares.lo)), bright_norm = sqrt(sum_used(squares.hi));
  const float2 inverse_norms = *(global const float2*)(side_patches + kInverseNorms);
  return fmax(dark_norm < 1e-10f ? 0.0f : sum_used(products.lo) * inverse_norms.x / dark_norm,
              bright_norm < 1e-10f ? 0.0f : sum_used(products.hi) * inverse_norms.y / bright_norm);
}

// LONG: a row from shift to similarity; its patches stay in private memory.
kernel IN_VECTORS void stereo_refinement(const StereoRefinementArguments args, global const int* first,
                                         global const int* target, global const float* ncc,
                                         global const uint* left_corners, global const uint* right_corners,
                                         global const char* left_patches, global const float* left_edges,
                                         global const float* right_edges, global uchar* state, global float* position,
                                         global float* similarity) {
  const int i = (int)get_global_id(0);
  if (i >= args.left.count) return;
  const int begin = first[i], end = min(first[i + 1], args.capacity);
  if (begin >= end) return;
  RefinedEdge edge;
  open_edge(&args, left_edges, i, &edge);
  const EpipolarLine line = edge.line;
  global const char* side_patches = left_patches + (size_t)i * kEdgePatchBytes;
  const PatchFrame frame = patch_frame(edge.x, edge.y, edge.cosine, edge.sine, 0.0f, 0.0f);
  float8 fixed[kPatchRows], derivative[kPatchRows], values[kPatchRows];
  float fixed_norm = 0.0f;
  int ready = 0;
  for (int c = begin; c < end; ++c) {
    if (state[c] != kCandidateAlive) continue;
    position[c] = epipolar_shift(&args, &line, right_edges, target[c]);
    choose_representative(begin, c, ncc, position, state);
  }
  for (int c = begin; c < end; ++c) {
    if (state[c] != kCandidateAlive) continue;
    if (!ready) {
      cut_patch(left_corners, args.left_width, args.left_height, frame, 0.0f, 0.0f, fixed);
      fixed_norm = patch_norm(fixed);
      patch_derivative(left_corners, args.left_width, args.left_height, frame, line.ex, line.ey, derivative);
      ready = 1;
    }
    float s = position[c];
    // Patches are cut with the left direction in both images.
    const PatchFrame moving =
        patch_frame(line.x + s * line.ex, line.y + s * line.ey, edge.cosine, edge.sine, 0.0f, 0.0f);
    float move = 0.0f;
    const int aligned = align_edge(right_corners, args.right_width, args.right_height, moving, line.ex, line.ey, fixed,
                                   fixed_norm, derivative, edge.stiffness, args.alignment, values, &move);
    if (aligned == ALIGN_LEFT) {
      state[c] = (uchar)args.rejected_order;
      continue;
    }
    s += move;
    position[c] = s;
    const float right_x_now = line.x + s * line.ex, right_y_now = line.y + s * line.ey;
    if (aligned == ALIGN_MOVED) {
      cut_patch(right_corners, args.right_width, args.right_height,
                patch_frame(right_x_now, right_y_now, edge.cosine, edge.sine, 0.0f, 0.0f), 0.0f, 0.0f, values);
    }
    const float on_edge = rows_ncc(fixed, fixed_norm, values);
    // A similar side cannot compensate for a dissimilar centre, which gets the lowest similarity of a side.
    float beside = -1.0f;
    if (0.5f * (on_edge + 1.0f) >= args.similarity_min) {
      beside = better_side(right_corners, args.right_width, args.right_height,
                           patch_frame(right_x_now, right_y_now, edge.cosine, edge.sine, 1.0f, args.patch_offset),
                           patch_frame(right_x_now, right_y_now, edge.cosine, edge.sine, -1.0f, args.patch_offset),
                           side_patches);
    }
    similarity[c] = 0.5f * (on_edge + beside);
  }
  follow_representatives(begin, end, args.rejected_order, position, state, similarity);
}
