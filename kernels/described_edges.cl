// described_edges.cl: parts of the side patches (patches.cl) and SIFT descriptors (sift.cl) of an edge. Functions only.
//
// An edge's patches begin at a multiple of 16 bytes and its descriptors at one of 256. The vector types say so, and
// compilers read each part in one load; vload16 promises the alignment of a single byte only.

static inline char16 patch_row(global const char* patch, const int row) { return ((global const char16*)patch)[row]; }

// The patches of stereo edge `edge`; numbers 0: they have the numbers of the stereo edges.
static inline global const char* patch_of(global const char* patches, global const int* numbers, const int edge) {
  return patches + kEdgePatchBytes * (size_t)(numbers ? numbers[edge] : edge);
}

// 1 / norm of the dark and of the bright patch.
static inline float2 patch_norms(global const char* patch) { return *(global const float2*)(patch + kInverseNorms); }

// Sixteen bytes of both descriptors: 0 to 7 of the dark side, 8 to 15 of the bright side.
static inline uchar16 descriptor_part(global const uchar* descriptor, const int part) {
  return ((global const uchar16*)descriptor)[part];
}
