#pragma once
// Free paths and transmittance of many rays at once: what Tracker does for one, in SIMD lanes. Each
// lane follows a ray of a batch and takes the next one when its own has ended, so that lanes stay
// busy however different their lengths are. What comes out for a ray depends on that ray alone.
//
// In float, in index space: positions are good to 1e-7 of the volume's edge, and lengths count from
// a ray's own origin, so that a short free path keeps its digits. That is too little for
// extinctions beyond what a picture resolves; serves() says for which volumes it is enough, and
// Tracker is there for the others. The instruction set is chosen when the program runs (Highway).

#include "clip/keep/Clip.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Domain.h"
#include "model/volume/Volume.h"
#include "transport/lanes/TrackerTables.h"
#include "transport/readable/Counters.h"
#include "transport/readable/MajorantGrid.h"
#include "transport/readable/StopFlag.h"

#include <array>
#include <string>
#include <vector>

namespace fenestra {

/// One number for each of the rays that are followed together, and room for as many lanes as there
/// may be, so that whole vectors can be read and written.
template <typename T>
struct alignas(64) Column : std::array<T, 512 + 16> {};
using Columns3 = std::array<Column<float>, 3>;

/// Rays that are followed together; a structure of arrays.
struct RayBatch {
  static constexpr std::size_t capacity = 512;

  std::size_t size = 0;
  Columns3 origin;            ///< index space, inside the domain
  Columns3 direction;         ///< index space per mm: t is in mm
  Column<float> length;       ///< mm to where the ray ends or leaves the domain
  Column<std::uint32_t> seed; ///< of the ray's own random numbers
  Column<float> result;       ///< mm to the collision, or infinity; or the transmittance
  Column<float> scalar;       ///< at the collision

  bool full() const { return size == capacity; }
  void set(std::size_t i, const Ray& indexRay, double lengthInMm, std::uint32_t seedOfRay) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      origin[a][i] = static_cast<float>(indexRay.origin[axis]);
      direction[a][i] = static_cast<float>(indexRay.direction[axis]);
    }
    length[i] = static_cast<float>(lengthInMm);
    seed[i] = seedOfRay;
  }
};

/// Makes ray i the part of a world-space ray that lies in the domain and in `range`; where there is
/// none, a ray of no length. Returns where it begins, in mm along the ray: lengths count from
/// there, so that free paths keep their digits however far away the ray began.
double setInside(RayBatch& rays, std::size_t i, const Domain& domain, const Ray& ray,
                 const Interval& range, std::uint32_t seed);

class WideTracker {
public:
  /// Whether floats suffice and every part of the medium is known to the lanes: no gradient
  /// opacity, at least two voxels along x, at most 2^31 of them, and an optical depth
  /// across the volume of at most 1e5.
  static bool serves(const Volume& volume, const TransferFunction& transfer);

  /// A view: volume, clip, style and stop outlive it. Once `stop` is true rays are left where they
  /// are, and what results hold means nothing.
  WideTracker(const Volume& volume, const Domain& domain, const TransferFunction& transfer,
              const MajorantGrid& majorants, const Clip& clip, const ContextStyle* style = nullptr,
              const StopFlag& stop = neverStopped);

  const WideScene& scene() const { return m_scene; }

  /// result: distance (mm) from the origin to the next real collision, or infinity; and the scalar
  /// there.
  void sampleCollisions(RayBatch& rays, Counters& counters) const;
  /// result: unbiased estimate of the transmittance along the whole length, by ratio tracking with
  /// Russian roulette; by delta tracking where an exact clipping surface cuts.
  void estimateTransmittances(RayBatch& rays, Counters& counters) const;

  /// The instruction sets that this program has and this machine knows, the best first, as Highway
  /// calls them: AVX3 (AVX-512), AVX2, SSE4, SCALAR (none needed).
  static std::vector<std::string> instructionSets();
  /// The one in use: the best, unless another was pinned.
  static std::string instructionSet();
  /// Pins one of instructionSets(), for the whole process (the command line does it on behalf of
  /// the environment variable FENESTRA_INSTRUCTIONS); throws Error (usage) for any other. Not while
  /// rays are followed.
  static void useInstructionSet(const std::string& name);

private:
  void setDomain(const Domain& domain);
  void setCells(const MajorantGrid& majorants);
  void setClip(const Clip& clip, const Grid& grid);
  void setContext(const ContextStyle& style, const Grid& grid);

  WideScene m_scene;
  const StopFlag& m_stop;
};

} // namespace fenestra
