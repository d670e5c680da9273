#pragma once
// Free paths and transmittance of many rays at once: what Tracker does for one, in SIMD lanes. Each
// lane follows a ray of a batch and takes the next one when its own has ended, so that lanes stay
// busy however different their lengths are. What comes out for a ray depends on that ray alone.
//
// In float, in index space: positions are good to 1e-7 of the volume's edge, and lengths count from
// a ray's own origin, so that a short free path keeps its digits. That is too little for
// extinctions beyond what a picture resolves; serves() says for which volumes it is enough, and
// Tracker is there for the others. The instruction set is chosen when the program runs (Highway).

#include "clipping/Clip.h"
#include "medium/TransferFunction.h"
#include "tracking/Counters.h"
#include "tracking/MajorantGrid.h"
#include "volume/Domain.h"
#include "volume/Volume.h"

#include <array>
#include <string>
#include <vector>

namespace fenestra {

/// Rays that are followed together; a structure of arrays.
struct RayBatch {
  static constexpr std::size_t capacity = 256;
  template <typename T>
  struct alignas(64) Column : std::array<T, capacity> {};

  std::size_t size = 0;
  std::array<Column<float>, 3> origin;    ///< index space, inside the domain
  std::array<Column<float>, 3> direction; ///< index space per mm: t is in mm
  Column<float> length;                   ///< mm to where the ray ends or leaves the domain
  Column<std::uint32_t> seed;             ///< of the ray's own random numbers
  Column<float> result; ///< mm to the collision, or infinity; or the transmittance

  bool full() const { return size == capacity; }
  void add(const Ray& indexRay, double lengthInMm, std::uint32_t seedOfRay) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      origin[a][size] = static_cast<float>(indexRay.origin[axis]);
      direction[a][size] = static_cast<float>(indexRay.direction[axis]);
    }
    length[size] = static_cast<float>(lengthInMm);
    seed[size] = seedOfRay;
    ++size;
  }
};

/// What the lanes read: plain numbers and pointers, in float and index space. Built by WideTracker.
struct WideScene {
  /// In the order of Voxels' alternatives.
  enum class VoxelType { uint8, int16, uint16, float32 };
  /// Cells and voxels along one axis.
  struct Axis {
    float last;              ///< index of the last voxel
    std::int32_t lastCell;   ///< of the last pair of voxels that interpolation may begin with
    std::int32_t stride;     ///< voxels to the next in this axis, 0 where there is none
    float cellEdge;          ///< voxels
    std::int32_t cells;      ///< without the border
    std::int32_t cellStride; ///< of the cells, in their bordered array
  };
  /// The clipping depth's samples along one axis (clipping/DepthBuffer.h).
  struct DepthAxis {
    float perPitch, start, lastInside, before, perFactor, last;
  };
  enum class ClipKind { none, plane, depthLinear, depthNearest };

  VoxelType type;
  const void* voxels;
  std::int64_t voxelCount;
  std::array<Axis, 3> axes;

  /// Extinction over the scalar: in segment i it is value[i] + slope[i] (s - position[i]), from
  /// position[i] to position[i + 1]; the first begins at -infinity, the last has no end.
  std::vector<float> position, value, slope;
  std::vector<std::int32_t> binSegment; ///< for equal bins from binStart on: the first candidate
  float binStart, binsPerUnit;

  /// The majorants' cells, with a border of empty ones around them. Positive: the majorant (mm^-1),
  /// its last bit set where keep is to be asked. Otherwise the cell is empty, and so are as many
  /// more to every side, diagonals included, as the value is below 0.
  std::vector<float> cells;

  ClipKind clipKind = ClipKind::none;
  bool perspective = false;
  /// Rows of the map from index space to view space, depth counted from the target.
  std::array<std::array<float, 4>, 3> toView = {};
  std::array<float, 4> toPlane = {}; ///< distance from a plane, positive where it removes
  float targetDepth = 0.0F;
  DepthAxis depthX = {}, depthY = {};
  const float* depths = nullptr; ///< counted from the target
  std::int32_t depthColumns = 0;
};

/// Adds the part of a world-space ray that lies in the domain and in `range`; where there is none,
/// a ray of no length. Returns where it begins, in mm along the ray: lengths count from there, so
/// that free paths keep their digits however far away the ray began.
double addInside(RayBatch& rays, const Domain& domain, const Ray& ray, const Interval& range,
                 std::uint32_t seed);

class WideTracker {
public:
  /// Whether floats suffice and every part of the medium is known to the lanes: no gradient
  /// opacity, at least two voxels along x, 32-bit voxel indices, and an optical depth across the
  /// volume of at most 1e4.
  static bool serves(const Volume& volume, const TransferFunction& transfer);

  /// A view: volume and clip outlive it.
  WideTracker(const Volume& volume, const TransferFunction& transfer, const MajorantGrid& majorants,
              const Clip& clip);

  /// result: distance (mm) from the origin to the next real collision, or infinity.
  void sampleCollisions(RayBatch& rays, Counters& counters) const;
  /// result: unbiased estimate of the transmittance along the whole length, by ratio tracking with
  /// Russian roulette.
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
  void setTable(const ScalarFunction& extinction);
  void setCells(const MajorantGrid& majorants, const Grid& grid);
  void setClip(const Clip& clip, const Grid& grid);

  WideScene m_scene;
};

} // namespace fenestra
