// Numbers of a scene, in one layout for C++ and GLSL (std430): maps first, which GLSL aligns to 16
// bytes. Offsets count words of 32 bits in the scene's tables (gpu/SceneTables.h). Lengths in mm.

/// One axis of the voxel grid, for interpolation.
struct VoxelAxis {
  Real last, lastCell; ///< as locateOnAxis's
  Int step;            ///< to the next voxel: 1; 0 along an axis of one voxel
};

/// Majorant cells along one axis (SimdMedium::Axis).
struct CellAxis {
  Real cellEdge, cellsPerVoxel, insideCells, cellStride;
};

struct SceneNumbers {
  AffineRows toLocal;      ///< points, index to local space (SimdShading)
  AffineRows localToIndex; ///< directions
  AffineRows toCrop;       ///< points, index to crop space
  AffineRows toGradient;   ///< differences across two voxels (SimdShading)
  AffineRows fromView;     ///< directions, view space to world
  AffineRows toWeights;    ///< points, index to the label weights' index space
  AffineRows toFocus;      ///< points, index to the focus mask's index space
  AffineRows viewToCells;  ///< points, view space (depth relative to the target) to cell space
  AffineRows viewToIndex;  ///< the same to index space
  AffineRow toPlane;       ///< distance from a clip plane; > 0: removed
  AffineRow cutNormal;     ///< of a plane; else the view axis
  AffineRow lower, upper;  ///< the domain's box, index space

  /// CameraTable: on the near plane, and directions.
  AffineRow point, pointPerColumn, pointPerRow;
  AffineRow forward, forwardPerColumn, forwardPerRow;
  Real middleColumn, middleRow; ///< raster position of the image's center

  VoxelAxis voxelsX, voxelsY, voxelsZ;
  CellAxis cellsX, cellsY, cellsZ;
  Int cells;               ///< offset of SimdMajorants::codes
  Real firstCell, endCell; ///< index of the first inner and of the last cell
  Real overshoot;

  /// Extinction functions (SimdLines): offset, words per function, bins; then their segments.
  Int lines, lineWords;
  Real lineStart, linesPerUnit, lastLine;
  Int extinctions, albedos; ///< offsets of the first table of segments

  Real constantRed, constantGreen, constantBlue; ///< radiance of all constant environments
  Int maps;                                      ///< offset of the first environment map

  /// Label weights: last voxels, and offsets of the next brick; then offsets of their tables.
  VoxelAxis weightsX, weightsY, weightsZ;
  Int bricks, mergedBricks, planes;
  Int unclipped; ///< offset of 1 per component that is unclipped

  /// ContextStyle and its focus mask.
  VoxelAxis focusX, focusY, focusZ;
  Real focusLevel, contextExtinction, contextSaturation;

  Int bsdfs;        ///< offset of the first Bsdf's numbers
  Real surfaceRate; ///< SimdShading
  Int nets;         ///< offset of Sampler::nets
  Int bounces;      ///< maximum number of scatterings

  Int depths, depthColumns; ///< offset and columns of the depth buffer
  Real cutSlope;            ///< length of a soft cut's gradient, mm^-1

  /// Silhouette cells: per sample its cell, or -1; silhouetteWords per cell: depth bounds, isInner.
  Int silhouetteCells, silhouettes;
  Real surfaceOffset; ///< SilhouetteCells::move
  /// FocusCells: cells and blocks along the axes; offsets of blocks, corners and values (-1: voxels
  /// are 0 and 1 only); indicator per unit of a value.
  Real focusCellsX, focusCellsY, focusCellsZ;
  Int focusBlocksX, focusBlocksY, focusBlocksZ;
  Int focusBlocks, focusCorners, focusValues;
  Real focusScale;
  Int isFocusInside; ///< the domain contains all cells

  ClipTable clip; ///< begins at a multiple of 16 bytes: Layout.h
};
