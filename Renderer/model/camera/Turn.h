#pragma once
// Going around what is looked at, as a turntable shows it.

#include "model/camera/Camera.h"

namespace fenestra {

/// The eye goes around the axis that leads through the target along `up`: counter-clockwise for who
/// looks down that axis, so that the subject seems to turn clockwise. It stays as far away and as
/// high; by 0 degrees it is the same pose, bit for bit.
inline CameraPose turnedAroundTarget(const CameraPose& pose, double degrees) {
  CameraPose turned = pose;
  const Mat3 turn = rotationBy(degrees * pi / 180.0, pose.up.stableNormalized()).linear();
  if (degrees != 0.0)
    turned.position = pose.target + turn * (pose.position - pose.target);
  return turned;
}

} // namespace fenestra
