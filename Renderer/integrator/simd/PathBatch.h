#pragma once
// Paths traced together, as structures of arrays: their camera samples, state and results.

#include "integrator/simd/Tracker.h"

namespace fenestra::core {

/// Samples for which paths start, each with its pixel.
struct CameraSamples {
  std::size_t size = 0;
  bool isStratified = false;
  SoaArray<float> column, row;        ///< of the pixel
  SoaArray<float> from, to;           ///< part of the camera ray left by the clip; see beginPaths
  SoaArray<std::uint32_t> start, key; ///< Sampler::Stream
  SoaArray<std::uint32_t> number;     ///< index of the sample in the stream
  SoaArray<std::uint32_t> tile,
      tileSample; ///< destination of the result: tile, and sample within it
};

/// `Path` as a structure of arrays, oldest paths first.
struct PathBatch {
  RayBatch rays;       ///< next rays, and their collisions
  SoaArray3 direction; ///< of the rays: world axes, unit
  SoaArray3 throughput, radiance;
  SoaArray<float> scatterPdf;
  SoaArray<std::int32_t> bounces;
  SoaArray<std::uint32_t> key, counter;      ///< of the paths' random number streams
  SoaArray<std::uint32_t> tile, tileSample;  ///< as CameraSamples
  std::array<SoaArray<float>, 2> uDirection; ///< random numbers of the first scattered direction
  std::array<SoaArray<float>, 2> uChoices;   ///< random numbers at the first vertex: surface, light

  /// Camera rays, used until the first collision: row of the pixel, direction, depth at the ray's
  /// start (mm, relative to CameraTable::nearDepth), and depth per mm of the ray.
  SoaArray<float> row;
  SoaArray3 cameraDirection;
  SoaArray<float> depth, depthPerLength;

  /// First collision; depth is relative to nearDepth, too.
  SoaArray<float> firstDepth;
  SoaArray3 firstAlbedo, firstNormal;

  /// Bit set: bit i % 64 of word i / 64 is 1 if path i has ended.
  std::array<std::uint64_t, RayBatch::capacity / 64> ended;
};

} // namespace fenestra::core
