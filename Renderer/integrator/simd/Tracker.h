#pragma once
// Tracker in SIMD: free flights and transmittance of many rays at once. Each lane traces a ray of a
// batch and takes the next ray when its own has ended, so that lanes stay busy however different
// the rays' lengths are. The result for a ray depends on that ray alone.
//
// Floats, in index space: positions are accurate to 1e-7 of the volume's edge, and lengths count
// from each ray's own origin, so that short free paths keep their precision. Media for which
// isSupported() is false need the scalar Tracker. Highway selects the instruction set at run time,
// and the image records it.

#include "base/StopFlag.h"
#include "clip/field/Clip.h"
#include "integrator/scalar/Counters.h"
#include "integrator/scalar/MajorantGrid.h"
#include "integrator/simd/Medium.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Domain.h"
#include "model/volume/Volume.h"

#include <array>

namespace fenestra::core {

/// One element per ray of a batch, padded by the maximum number of lanes, so that complete vectors
/// can be loaded and stored.
template <typename T>
struct alignas(64) SoaArray : std::array<T, 512 + 16> {};
using SoaArray3 = std::array<SoaArray<float>, 3>;

/// Rays traced together, as a structure of arrays.
struct RayBatch {
  static constexpr std::size_t capacity = 512;

  std::size_t size = 0;
  SoaArray3 origin;       ///< index space, inside the domain
  SoaArray3 direction;    ///< index space per mm: t is in mm
  SoaArray<float> length; ///< mm to the ray's end or its exit from the domain
  /// Random numbers of the first tentative collision: bits of its optical depth, and its acceptance
  /// in [0, 1]. All later numbers are hashes of a counter that starts at these bits.
  SoaArray<std::uint32_t> depthBits;
  SoaArray<float> acceptance;
  SoaArray<float> result; ///< distance to the collision, mm, or infinity; or the transmittance
  SoaArray<float> scalar; ///< at the collision

  void set(std::size_t i, const Ray& indexRay, double lengthInMm) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      origin[a][i] = static_cast<float>(indexRay.origin[axis]);
      direction[a][i] = static_cast<float>(indexRay.direction[axis]);
    }
    length[i] = static_cast<float>(lengthInMm);
  }
};

/// Sets ray i to the part of a world-space ray inside the domain and `range`; to a ray of length 0
/// if that part is empty. Returns the start of the part, mm along the ray. Lengths count from
/// there, so that free paths keep their precision even if the ray's origin is far away.
double setDomainRay(RayBatch& rays, std::size_t i, const Domain& domain, const Ray& ray,
                    const Interval& range);

class SimdTracker {
public:
  /// True if floats suffice and the medium is supported: no gradient opacity, at least two voxels
  /// along x (four for Sobel's gradient), 4 to 2^31 in total, diagonal at most 2^17 edges of the
  /// smallest voxel, optical depth across the volume <= 1e5.
  static bool isSupported(const Volume& volume, const TransferFunction& transfer,
                          const Mixture* mixture = nullptr);

  /// Non-owning: volume, clip, style, mixture and stop must outlive the tracker. Once `stop` is
  /// true, rays end early and results are meaningless.
  SimdTracker(const Volume& volume, const Domain& domain, const TransferFunction& transfer,
              const MajorantGrid& majorants, const Clip& clip, const ContextStyle* style = nullptr,
              const StopFlag& stop = neverStopped, const Mixture* mixture = nullptr);

  const SimdMedium& medium() const { return m_medium; }

  /// result: distance (mm) from the origin to the next real collision, or infinity; scalar: the
  /// value there.
  void sampleCollisions(RayBatch& rays, Counters& counters) const;
  /// result: unbiased estimate of the transmittance along each ray, by ratio tracking with Russian
  /// roulette; by delta tracking where an exact clipping surface cuts.
  void estimateTransmittances(RayBatch& rays, Counters& counters) const;

private:
  SimdMedium m_medium;
  const StopFlag& m_stop;
};

} // namespace fenestra::core
