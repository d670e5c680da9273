// A batch of paths, in one layout for C++ and GLSL (std430).

/// Where a path starts.
struct PathStart {
  Int column, row;         ///< of the pixel
  UInt start, key, number; ///< Sampler::Stream, and the sample's index in it
};

/// Bytes reserved for a thread's PathState.
CONSTANT Int stateBytes = 192;

/// Words of a table of segments, and of each kind of light.
CONSTANT Int tableWords = 7;
CONSTANT Int bsdfWords = 10;
CONSTANT Int skyWords = 12;
CONSTANT Int directionalWords = 7;
CONSTANT Int areaWords = 20;
CONSTANT Int sphereWords = 8;
CONSTANT Int mapWords = 13;
CONSTANT Int silhouetteWords = 3;

/// Voxels along an edge of a brick, and bytes of a LabelWeights::Plane.
CONSTANT Int brickVoxels = 5;
CONSTANT Int planeBytes = 128;

/// Kinds of counted work (Counters).
CONSTANT Int collisionCount = 0;
CONSTANT Int lookupCount = 1;
CONSTANT Int cellCount = 2;
CONSTANT Int skippedCellCount = 3;
CONSTANT Int shadowRayCount = 4;
CONSTANT Int gradientCount = 5;
CONSTANT Int workKinds = 6;
