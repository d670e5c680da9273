#include "FenestraImagePoint.h"

#include <cmath>
#include <sstream>

namespace SlicerExport {
namespace {

/// Value of "--name value" or "--name=value"; empty: absent.
std::string findOption(const std::string& options, const std::string& name) {
  std::istringstream words(options);
  for (std::string word; words >> word;) {
    if (word.rfind("--" + name + "=", 0) == 0)
      return word.substr(name.size() + 3);
    if (word == "--" + name && words >> word)
      return word;
  }
  return {};
}

std::optional<Point> parsePoint(const std::string& text) {
  std::istringstream words(text);
  words.imbue(std::locale::classic());
  Point point = {};
  char comma = ',';
  for (double& coordinate : point)
    if (!(words >> coordinate) || (&coordinate != &point.back() && !(words >> comma)))
      return std::nullopt;
  return point;
}

} // namespace

std::optional<ImageCamera> parseImageCamera(const std::string& options) {
  const std::string projection = findOption(options, "projection");
  const std::optional<Point> position = parsePoint(findOption(options, "position"));
  const std::optional<Point> target = parsePoint(findOption(options, "target"));
  if (!position || !target || (projection != "orthographic" && projection != "perspective"))
    return std::nullopt;
  return ImageCamera{projection == "orthographic", *position, *target};
}

Point findImagePoint(const ImageCamera& camera, const Point& pixel, double depth) {
  const Point &eye = camera.position, &target = camera.target;
  const double targetDepth = std::hypot(target[0] - eye[0], target[1] - eye[1], target[2] - eye[2]);
  Point point = {};
  for (std::size_t i = 0; i < point.size(); ++i)
    point[i] = camera.isOrthographic ? pixel[i] + (depth / targetDepth - 1.0) * (target[i] - eye[i])
                                     : eye[i] + depth / targetDepth * (pixel[i] - eye[i]);
  return point;
}

} // namespace SlicerExport
