#pragma once
// The synthetic subjects. Voxels do not depend on run or number of threads. Every function throws
// Error (request) unless each axis has 16 to 1024 voxels.

#include "phantoms/Phantom.h"

namespace fenestra::core {

inline constexpr Size3 kneeSize{300, 344, 120}, footSize{300, 120, 150}, fetusSize{160, 160, 160};

/// Right knee as in a T1-weighted sagittal MR scan; every structure is a segment. Voxel axes point
/// posterior, inferior and right; field of view: 120 x 137.6 x 120 mm. The femoral cartilage has a
/// full-thickness lesion on the medial slope of the trochlea and a half-thickness lesion on the
/// lateral condyle.
Phantom makeKneePhantom(const Size3& size = kneeSize, const PhantomProgress& progress = {});

/// Right foot as in CT, in Hounsfield units. Voxel axes point anterior, left and superior; field of
/// view: 280 x 112 x 140 mm. Layer 0 has a segment for each of the foot's 26 bones, the ends of
/// tibia and fibula, and the soft tissues; layer 1 has the segment "bones": all voxels of at least
/// 200 HU.
Phantom makeFootPhantom(const Size3& size = footSize, const PhantomProgress& progress = {});

/// Head of a fetus of about 28 weeks as in obstetric ultrasound from the front. Voxel axes point
/// left, posterior and superior; field of view: 112 x 112 x 112 mm. Values are 0 to 255, with
/// speckle and attenuation. The face, with a hand beside it, is one segment; the uterine wall and a
/// loop of the cord hide it from the front.
Phantom makeFetusPhantom(const Size3& size = fetusSize, const PhantomProgress& progress = {});

struct CubeOptions {
  double edge = 1.0;       ///< mm; the published model is a unit cube
  std::int64_t size = 512; ///< voxels along each edge
};

/// Simulated model of the paper in CITATION.cff (section 4): a cube whose scalar is its z index,
/// around a cuboid focus. Voxel axes are R, A, S; the cube is centered at the origin. Slice k of n
/// holds 255 (2 k - (n - 1)) / (n - 1), rounded: -255 in the first slice, 255 in the last. With 512
/// slices the middle two hold 0, and each other slice holds one more than the slice below: the z
/// index relative to the middle. The segment "focus" has 255 x 255 x 391 voxels of 512, its long
/// edge along z; other sizes use the same proportions, rounded. Along an axis where n and the focus
/// differ by an odd number, the focus lies half a voxel below the middle. Labels cover the focus
/// only. Throws Error (request) unless edge > 0.
Phantom makeCubePhantom(const CubeOptions& options = {});

} // namespace fenestra::core
