// A clip (clip/field/Clip.h) as numbers. Lengths in mm; depth is relative to the target.

/// Samples of the depth buffer along one axis: DepthAxis (clip/focus/DepthBuffer.h) or, with "per",
/// 1 / its members; last = size - 1, lastInside = inside - 1.
struct DepthTable {
  Real perPitch, start, lastInside, before, perFactor, last;
};

struct ClipTable {
  Real ghost;       ///< ClipEdge
  Real softness;    ///< mm
  Real perSoftness; ///< 1 / mm; 0: sharp edge
  bool perspective;
  Real targetDepth;
  AffineRows toView; ///< rows of the map from index space to view space
  DepthTable depthX, depthY;
};
