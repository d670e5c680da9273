#pragma once
// From a pixel of an image to the anatomy that it shows. Needs only standard C++.

#include "FenestraImage.h"

#include <array>
#include <optional>
#include <string>

namespace SlicerExport {

using Point = std::array<double, 3>; ///< RAS, mm

/// What the depths of an image are measured from.
struct ImageCamera {
  bool isOrthographic = true;
  Point position = {}, target = {};
};

/// Field of a depth image's header that holds its camera, as options of the renderer.
constexpr const char* cameraField = "camera";

/// Reads that field's text; nullopt: it names no complete camera.
std::optional<ImageCamera> parseImageCamera(const std::string& options);

/// The point at `depth` mm in front of the camera, along its axis, that a pixel shows. `pixel`: the
/// pixel's center, in the plane through the target.
Point findImagePoint(const ImageCamera& camera, const Point& pixel, double depth);

} // namespace SlicerExport
