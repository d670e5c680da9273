#include "phantoms/Phantom.h"

#include "base/Error.h"

namespace fenestra::core {

Grid makePhantomGrid(const Size3& size, const Vec3& fieldOfView, const Mat3& axes,
                     const Vec3& center) {
  if ((size.array() < 16).any() || (size.array() > 1024).any())
    throw requestError(ErrorCode::invalidValue, "size", "each axis must have 16 to 1024 voxels");
  const Vec3 spacing = fieldOfView.cwiseQuotient(size.cast<double>());
  Affine indexToWorld = Affine::Identity();
  indexToWorld.linear() = axes * Mat3::Diagonal(spacing);
  const Vec3 middle = 0.5 * (size.cast<double>() - Vec3::Ones());
  indexToWorld.translation() = center - indexToWorld.linear() * middle;
  return {size, indexToWorld};
}

} // namespace fenestra::core
