#include "files/appearance/PropertyWriter.h"

#include "base/Text.h"
#include "io/ProvenanceTag.h"

#include <nlohmann/json.hpp>

#include <limits>

namespace fenestra::core {

namespace {

using Json = nlohmann::ordered_json;

Json encodePiecewiseLinear(const std::vector<OpacityNode>& nodes) {
  Json points = Json::array();
  for (const OpacityNode& node : nodes)
    points.push_back({{"x", node.x},
                      {"y", node.value},
                      {"midpoint", node.midpoint},
                      {"sharpness", node.sharpness}});
  return {{"type", "piecewiseLinearFunction"}, {"points", points}};
}

Json encodeColorTransfer(const std::vector<ColorNode>& nodes) {
  Json points = Json::array();
  for (const ColorNode& node : nodes)
    points.push_back({{"x", node.x},
                      {"color", {node.value.x(), node.value.y(), node.value.z()}},
                      {"midpoint", node.midpoint},
                      {"sharpness", node.sharpness}});
  return {{"type", "colorTransferFunction"}, {"points", points}};
}

std::string encodeNumbers(const std::vector<double>& numbers) {
  return concat(numbers.size(), numbers.empty() ? "" : " ",
                joinNumbers(numbers, " ", std::numeric_limits<double>::digits10));
}

std::string encodeOpacity(const std::vector<OpacityNode>& nodes, double unitsPerMm) {
  std::vector<double> numbers;
  for (const OpacityNode& node : nodes) {
    const double y = unitsPerMm == 1.0 ? node.value : 1.0 - std::pow(1.0 - node.value, unitsPerMm);
    numbers.insert(numbers.end(), {node.x, y});
  }
  return encodeNumbers(numbers);
}

} // namespace

std::string encodePropertyJson(const VolumeProperty& property, double minimum, double maximum) {
  const Json component = {{"componentWeight", 1.0},
                          {"shade", property.shade},
                          {"lighting",
                           {{"diffuse", property.diffuse},
                            {"ambient", ambientLight},
                            {"specular", property.specular},
                            {"specularPower", property.specularPower}}},
                          {"disableGradientOpacity", false},
                          {"scalarOpacityUnitDistance", property.unitDistance},
                          {"rgbTransferFunction", encodeColorTransfer(property.color)},
                          {"scalarOpacity", encodePiecewiseLinear(property.scalarOpacity)},
                          {"gradientOpacity", encodePiecewiseLinear(property.gradientOpacity)}};
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

PropertyStrings encodePropertyStrings(const VolumeProperty& property) {
  std::vector<double> color;
  for (const ColorNode& node : property.color)
    color.insert(color.end(), {node.x, node.value.x(), node.value.y(), node.value.z()});
  return {encodeOpacity(property.scalarOpacity, 1.0 / property.unitDistance),
          encodeOpacity(property.gradientOpacity, 1.0), encodeNumbers(color)};
}

std::string encodePropertyVp(const VolumeProperty& property) {
  const PropertyStrings strings = encodePropertyStrings(property);
  const std::initializer_list<double> numbers = {property.shade ? 1.0 : 0.0, property.diffuse,
                                                 ambientLight, property.specular,
                                                 property.specularPower};
  return concat("1\n", // linear interpolation
                joinNumbers(numbers, "\n"), '\n', strings.scalarOpacity, '\n',
                strings.gradientOpacity, '\n', strings.color, '\n');
}

} // namespace fenestra::core
