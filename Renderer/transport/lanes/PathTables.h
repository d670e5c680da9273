#pragma once
// Tables that the lanes' events read beside WideScene: scatterers and lights, in float.

#include "base/Narrow.h"
#include "model/lights/LightSet.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Grid.h"
#include "transport/lanes/Medium.h"

#include <vector>

namespace fenestra {

/// "Local" is world axes around the volume's centre: mm that keep their digits wherever it lies.
struct EventScene {
  using Triple = std::array<float, 3>;
  struct Area {
    bool disk;
    Triple center, normal; ///< local
    Triple right, up;      ///< half edges (mm), or the radius
    float perRight, perUp; ///< 1 / their squared lengths
    float area;            ///< mm^2
    Triple radiance;
    float share;
  };
  struct Directional {
    Triple toward, irradiance;
    float share;
  };

  /// Whether floats suffice: no lobe narrower than directions in float resolve, and no light so far
  /// or bright that its square has no float.
  static bool serves(const Grid& grid, const TransferFunction& transfer, const LightSet& lights);

  EventScene(const Grid& grid, const TransferFunction& transfer, const LightSet& lights,
             std::uint64_t mostBounces, bool normalsWanted);

  WideTable albedo;
  float g;
  bool hybrid; ///< shading
  float diffuse, specular, roughness;
  float surfaceRate; ///< of Medium's surface probability: 25 gamma^3
  bool wantNormals;
  std::int32_t bounces; ///< scatterings, at most

  std::vector<Area> areas;
  std::vector<Directional> directionals;
  Triple constantEnvironment;
  const LightSet* maps; ///< asked for environments that are not constant; null where none is

  AffineRows toLocal;      ///< points, from index space
  AffineRows localToIndex; ///< directions
  /// Differences over two voxels, to parts of the transfer function's span per mm.
  AffineRows indexDifferenceToGradient;
};

} // namespace fenestra
