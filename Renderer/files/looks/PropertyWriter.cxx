#include "files/looks/PropertyWriter.h"

#include "base/Text.h"
#include "base/safe/Mark.h"

#include <nlohmann/json.hpp>

#include <limits>

namespace fenestra {

namespace {

using Json = nlohmann::ordered_json;

Json piecewiseLinear(const std::vector<OpacityNode>& nodes) {
  Json points = Json::array();
  for (const OpacityNode& node : nodes)
    points.push_back({{"x", node.x},
                      {"y", node.value},
                      {"midpoint", node.midpoint},
                      {"sharpness", node.sharpness}});
  return {{"type", "piecewiseLinearFunction"}, {"points", points}};
}

Json colorTransfer(const std::vector<ColorNode>& nodes) {
  Json points = Json::array();
  for (const ColorNode& node : nodes)
    points.push_back({{"x", node.x},
                      {"color", {node.value.x(), node.value.y(), node.value.z()}},
                      {"midpoint", node.midpoint},
                      {"sharpness", node.sharpness}});
  return {{"type", "colorTransferFunction"}, {"points", points}};
}

std::string countedNumbers(const std::vector<double>& numbers) {
  return concat(numbers.size(), numbers.empty() ? "" : " ",
                joinNumbers(numbers, " ", std::numeric_limits<double>::digits10));
}

std::string opacityText(const std::vector<OpacityNode>& nodes, double unitsPerMm) {
  std::vector<double> numbers;
  for (const OpacityNode& node : nodes) {
    const double y = unitsPerMm == 1.0 ? node.value : 1.0 - std::pow(1.0 - node.value, unitsPerMm);
    numbers.insert(numbers.end(), {node.x, y});
  }
  return countedNumbers(numbers);
}

} // namespace

std::string propertyJson(const VolumeProperty& property, double minimum, double maximum) {
  const Json component = {{"componentWeight", 1.0},
                          {"shade", property.shade},
                          {"lighting",
                           {{"diffuse", property.diffuse},
                            {"ambient", ambientLight},
                            {"specular", property.specular},
                            {"specularPower", property.specularPower}}},
                          {"disableGradientOpacity", false},
                          {"scalarOpacityUnitDistance", property.unitDistance},
                          {"rgbTransferFunction", colorTransfer(property.color)},
                          {"scalarOpacity", piecewiseLinear(property.scalarOpacity)},
                          {"gradientOpacity", piecewiseLinear(property.gradientOpacity)}};
  const Json node = {{"effectiveRange", {minimum, maximum}},
                     {"isoSurfaceValues", Json::array()},
                     {"independentComponents", true},
                     {"interpolationType", "linear"},
                     {"useClippedVoxelIntensity", false},
                     {"clippedVoxelIntensity", 0.0},
                     {"scatteringAnisotropy", property.anisotropy},
                     {"components", Json::array({component})}};
  const Json file = {{"@schema",
                      "https://raw.githubusercontent.com/Slicer/Slicer/main/Modules/Loadable/"
                      "VolumeRendering/Resources/Schema/volume-property-schema-v1.0.0.json#"},
                     {"generator", blankProvenanceTag},
                     {"volumeProperties", Json::array({node})}};
  return sealProvenanceTag(file.dump(2) + "\n");
}

PropertyTexts propertyTexts(const VolumeProperty& property) {
  std::vector<double> color;
  for (const ColorNode& node : property.color)
    color.insert(color.end(), {node.x, node.value.x(), node.value.y(), node.value.z()});
  return {opacityText(property.scalarOpacity, 1.0 / property.unitDistance),
          opacityText(property.gradientOpacity, 1.0), countedNumbers(color)};
}

std::string propertyVp(const VolumeProperty& property) {
  const PropertyTexts texts = propertyTexts(property);
  const std::initializer_list<double> numbers = {property.shade ? 1.0 : 0.0, property.diffuse,
                                                 ambientLight, property.specular,
                                                 property.specularPower};
  return concat("1\n", // linear interpolation
                joinNumbers(numbers, "\n"), '\n', texts.scalarOpacity, '\n', texts.gradientOpacity,
                '\n', texts.color, '\n');
}

} // namespace fenestra
