// A clip (clip/field/Clip.h) as numbers. Lengths in mm; depth is relative to the target.

/// Samples of the depth buffer along one axis: DepthAxis (clip/focus/DepthBuffer.h) or, with "per",
/// 1 / its members; last = size - 1, lastInside = inside - 1.
struct DepthTable {
  Real perPitch, start, lastInside, before, perFactor, last;
};

/// GLSL aligns the map to 16 bytes: it comes first.
struct ClipTable {
  AffineRows toView; ///< rows of the map from index space to view space
  Real ghost;        ///< ClipEdge
  Real softness;     ///< mm
  Real perSoftness;  ///< 1 / mm; 0: sharp edge
  Real targetDepth;
  int isPerspective; ///< 1: perspective, 0: orthographic
  DepthTable depthX, depthY;
};
