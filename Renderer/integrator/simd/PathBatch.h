#pragma once
// Paths under way together, as structures of arrays: what begins, what goes on, what has ended.

#include "integrator/simd/Tracker.h"

namespace fenestra {

/// Samples to begin a path for, each in its pixel.
struct CameraSamples {
  std::size_t size = 0;
  bool isStratified = false;
  SoaArray<float> column, row;        ///< of the pixel
  SoaArray<float> from, to;           ///< part of the eye ray left by clipping: see beginPaths
  SoaArray<std::uint32_t> start, key; ///< Sampler::Stream
  SoaArray<std::uint32_t> number;     ///< of the sample in the stream
  SoaArray<std::uint32_t> tile,
      tileSample; ///< whom the sample is delivered to: tile, sample in there
};

/// Paths: `Path` as a structure of arrays, those that began first in front.
struct PathBatch {
  RayBatch rays;       ///< next rays, and their collisions
  SoaArray3 direction; ///< of the rays, world axes, unit
  SoaArray3 throughput, radiance;
  SoaArray<float> scatterPdf;
  SoaArray<std::int32_t> bounces;
  SoaArray<std::uint32_t> key, counter;      ///< of the paths' random numbers
  SoaArray<std::uint32_t> tile, tileSample;  ///< CameraSamples
  std::array<SoaArray<float>, 2> uDirection; ///< numbers of the first scattered directions
  std::array<SoaArray<float>, 2> uChoices;   ///< at the first collisions: surface or not, light

  /// Eye rays, of use until the first collision: row of the pixel, direction, depth at the ray's
  /// beginning (mm, counted from CameraTable::nearDepth) and its growth per mm of the ray.
  SoaArray<float> row;
  SoaArray3 cameraDirection;
  SoaArray<float> depth, depthPerLength;

  /// First collision; depth is counted as above.
  SoaArray<float> firstDepth;
  SoaArray3 firstAlbedo, firstNormal;

  /// Bit i % 64 of number i / 64: path i has ended.
  std::array<std::uint64_t, RayBatch::capacity / 64> ended;
};

} // namespace fenestra
