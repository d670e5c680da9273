#pragma once
// Free paths and transmittance of many rays at once: Tracker in SIMD lanes. Each lane follows a ray
// of a batch and takes the next ray when its own has ended, so that lanes stay busy however
// different the rays' lengths are. The result for a ray depends on that ray alone.
//
// In float, in index space: positions are good to 1e-7 of the volume's edge, and lengths count from
// a ray's own origin, so that a short free path keeps its digits. Float is not enough for
// extinctions beyond what a picture resolves; volumes for which serves() is false need Tracker. The
// instruction set is chosen at run time (Highway).

#include "clip/field/Clip.h"
#include "integrator/scalar/Counters.h"
#include "integrator/scalar/MajorantGrid.h"
#include "integrator/scalar/StopFlag.h"
#include "integrator/simd/Medium.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Domain.h"
#include "model/volume/Volume.h"

#include <array>

namespace fenestra {

/// One number for each ray of a batch, padded by the greatest number of lanes, so that whole
/// vectors can be read and written.
template <typename T>
struct alignas(64) SoaArray : std::array<T, 512 + 16> {};
using SoaArray3 = std::array<SoaArray<float>, 3>;

/// Rays followed together; a structure of arrays.
struct RayBatch {
  static constexpr std::size_t capacity = 512;

  std::size_t size = 0;
  SoaArray3 origin;       ///< index space, inside the domain
  SoaArray3 direction;    ///< index space per mm: t is in mm
  SoaArray<float> length; ///< mm until the ray ends or leaves the domain
  /// Random numbers of the first tentative collision: bits of the optical depth to it, and whether
  /// it is real, in [0, 1]. All others are hashes of what is counted from these bits.
  SoaArray<std::uint32_t> depthBits;
  SoaArray<float> acceptance;
  SoaArray<float> result; ///< mm to the collision, or infinity; or the transmittance
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
/// if that part is empty. Returns the beginning of the part, mm along the ray: lengths count from
/// there, so that free paths keep their digits, however far away the ray's origin is.
double setDomainRay(RayBatch& rays, std::size_t i, const Domain& domain, const Ray& ray,
                    const Interval& range);

class SimdTracker {
public:
  /// True if floats suffice and lanes support every part of the medium: no gradient opacity, at
  /// least two voxels along x, 4 to 2^31 voxels in all, its diagonal at most 2^17 of its smallest
  /// voxels' edges, optical depth across the volume <= 1e5.
  static bool isSupported(const Volume& volume, const TransferFunction& transfer,
                          const Mixture* mixture = nullptr);

  /// A view: volume, clip, style, mixture and stop must outlive the tracker. Once `stop` is true
  /// rays are abandoned and results are meaningless.
  SimdTracker(const Volume& volume, const Domain& domain, const TransferFunction& transfer,
              const MajorantGrid& majorants, const Clip& clip, const ContextStyle* style = nullptr,
              const StopFlag& stop = neverStopped, const Mixture* mixture = nullptr);

  const SimdMedium& medium() const { return m_medium; }

  /// result: distance (mm) from the origin to the next real collision, or infinity; and the scalar
  /// there.
  void sampleCollisions(RayBatch& rays, Counters& counters) const;
  /// result: unbiased estimate of the transmittance along the whole length, by ratio tracking with
  /// Russian roulette; by delta tracking where an exact clipping surface cuts.
  void estimateTransmittances(RayBatch& rays, Counters& counters) const;

private:
  SimdMedium m_medium;
  const StopFlag& m_stop;
};

} // namespace fenestra
