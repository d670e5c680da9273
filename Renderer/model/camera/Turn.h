#pragma once
// Poses of a turntable: the eye turned around the target.

#include "model/camera/Camera.h"

namespace fenestra {

/// Turns the eye about the axis through the target along `up`, counter-clockwise seen from the tip
/// of `up`: the subject seems to turn clockwise. Distance and height of the eye stay. 0 degrees
/// returns `pose`, bit for bit.
inline CameraPose turnedAroundTarget(const CameraPose& pose, double degrees) {
  CameraPose turned = pose;
  const Mat3 turn = rotationBy(degrees * pi / 180.0, pose.up.stableNormalized()).linear();
  if (degrees != 0.0)
    turned.position = pose.target + turn * (pose.position - pose.target);
  return turned;
}

} // namespace fenestra
