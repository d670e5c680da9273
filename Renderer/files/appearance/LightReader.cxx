#include "files/appearance/LightReader.h"

#include "base/Color.h"
#include "files/appearance/HexColor.h"
#include "files/images/ImageReader.h"
#include "io/InputRegistry.h"
#include "io/JsonNode.h"
#include "io/MessageText.h"

namespace fenestra::core {
namespace {

constexpr double maxNumber = 1e30; ///< limit of radiance and length; a product of two stays finite
constexpr float maxMapValue = 1e12f; ///< limit of the values of an environment map

Vec3 readDirection(const JsonNode& node) {
  const Vec3 v = node.triple(-maxNumber, maxNumber);
  if (v.isZero(0.0))
    throw node.error("is the zero vector; give a direction");
  return v.stableNormalized();
}

Rgb readTriple(const JsonNode& node) {
  return node.triple(0.0, maxNumber).array();
}

/// Radiance or irradiance of a light, under `key`: a triple, or together with "color" one number,
/// the luminance of light of that color.
Rgb readRadiance(const JsonNode& light, const std::string& key) {
  const auto color = light.find("color");
  const JsonNode value = light.at(key);
  if (value.isNumber() != color.has_value())
    throw value.error("must be one number with \"color\", and three numbers without");
  if (!color)
    return readTriple(value);
  const Rgb tint = readHexColor(*color);
  if (tint.isZero(0.0))
    throw color->error("is black; to switch a light off, set its radiance to 0");
  return tint * (value.number(0.0, maxNumber) / luminance(tint));
}

/// Reads a file name. Rejects null bytes and line breaks, so that messages stay on one line.
std::string readFileName(const JsonNode& node) {
  std::string name = node.text();
  if (name.find_first_of(std::string_view("\0\n\r", 3)) != std::string::npos)
    throw node.error("\"" + sanitize(name) + "\" is not a file name; remove its line breaks");
  return name;
}

Light readEnvironment(const JsonNode& node, const std::filesystem::path& folder) {
  node.allowOnly({"type", "color", "radiance", "file"});
  EnvironmentLight light;
  const auto file = node.find("file");
  if (file)
    light.map = readEnvironmentMap(folder / readFileName(*file));
  if (!file || node.find("radiance") || node.find("color"))
    light.radiance = readRadiance(node, "radiance");
  return light;
}

/// Coordinate frame of a light with a position.
LightFrame readFrame(const JsonNode& node) {
  return static_cast<LightFrame>(node.choice({"world", "camera", "focus"}));
}

Light readSky(const JsonNode& node) {
  node.allowOnly({"type", "top", "middle", "bottom", "up", "frame"});
  SkyLight light;
  light.top = readTriple(node.at("top"));
  light.middle = readTriple(node.at("middle"));
  light.bottom = readTriple(node.at("bottom"));
  if (const auto frame = node.find("frame"))
    light.frame = static_cast<LightFrame>(frame->choice({"world", "camera"}));
  if (const auto up = node.find("up"))
    light.up = readDirection(*up);
  else if (light.frame == LightFrame::world)
    light.up = Vec3::UnitZ(); // superior
  return light;
}

Light readDirectional(const JsonNode& node) {
  node.allowOnly({"type", "direction", "color", "irradiance"});
  return DirectionalLight{readDirection(node.at("direction")), readRadiance(node, "irradiance")};
}

/// Edges of a rectangle, or diameter of a disk: one number, or the same number twice.
Vec2 readSize(const JsonNode& node, AreaLight::Shape shape) {
  const bool disk = shape == AreaLight::Shape::disk;
  std::vector<double> size;
  if (disk && node.isNumber())
    size.assign(2, node.number(0.0, maxNumber));
  else
    size = node.numbers(2, 0.0, maxNumber);
  if (size[0] == 0.0 || size[1] == 0.0)
    throw node.error("must be above 0");
  if (disk && size[0] != size[1])
    throw node.error("must be one number for a disk, its diameter");
  return {size[0], size[1]};
}

Light readArea(const JsonNode& node, AreaLight::Shape shape) {
  node.allowOnly({"type", "center", "normal", "up", "size", "color", "radiance", "frame"});
  AreaLight light;
  light.shape = shape;
  light.center = node.at("center").triple(-maxNumber, maxNumber);
  light.normal = readDirection(node.at("normal"));
  if (const auto up = node.find("up"))
    light.up = readDirection(*up);
  light.size = readSize(node.at("size"), shape);
  light.radiance = readRadiance(node, "radiance");
  if (const auto frame = node.find("frame"))
    light.frame = readFrame(*frame);
  return light;
}

Light readSphere(const JsonNode& node) {
  node.allowOnly({"type", "center", "diameter", "color", "radiance", "frame"});
  SphereLight light;
  light.center = node.at("center").triple(-maxNumber, maxNumber);
  const JsonNode diameter = node.at("diameter");
  light.diameter = diameter.number(0.0, maxNumber);
  if (light.diameter == 0.0)
    throw diameter.error("must be above 0");
  light.radiance = readRadiance(node, "radiance");
  if (const auto frame = node.find("frame"))
    light.frame = readFrame(*frame);
  return light;
}

Light readLight(const JsonNode& node, const std::filesystem::path& folder) {
  const JsonNode type = node.at("type");
  const std::string name = type.text();
  if (name == "environment")
    return readEnvironment(node, folder);
  if (name == "sky")
    return readSky(node);
  if (name == "directional")
    return readDirectional(node);
  if (name == "rectangle")
    return readArea(node, AreaLight::Shape::rectangle);
  if (name == "disk")
    return readArea(node, AreaLight::Shape::disk);
  if (name == "sphere")
    return readSphere(node);
  throw type.error("must be environment, sky, directional, rectangle, disk or sphere");
}

} // namespace

std::vector<Light> readLights(const std::filesystem::path& path) {
  return parseLights(readText(path), path.string(), path.parent_path());
}

std::vector<Light> parseLights(std::string_view json, const std::string& source,
                               const std::filesystem::path& folder) {
  const nlohmann::json document = parseJson(json, source);
  const JsonNode root(document, source);
  root.allowOnly({"lights"});
  std::vector<Light> lights;
  for (const JsonNode& node : root.at("lights").elements())
    lights.push_back(readLight(node, folder));
  return lights;
}

bool hasFileReference(std::string_view json, const std::string& source) {
  const nlohmann::json document = parseJson(json, source);
  const std::vector<JsonNode> lights = JsonNode(document, source).at("lights").elements();
  return std::any_of(lights.begin(), lights.end(),
                     [](const JsonNode& light) { return light.find("file").has_value(); });
}

EnvironmentMap readEnvironmentMap(const std::filesystem::path& path) {
  if (lowercaseExtension(path) != ".exr")
    throw inputError(ErrorCode::unsupportedFile, path,
                     "is not an environment map; give a .exr file");
  const Image image = readImage(path);
  EnvironmentMap map{image.width, image.height, {}};
  const auto width = static_cast<std::size_t>(image.width);
  const std::size_t texels = width * static_cast<std::size_t>(image.height);
  map.rgb.resize(3 * texels);
  const std::string names[] = {"R", "G", "B"};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::vector<float>* plane = image.find(names[c]);
    if (!plane)
      throw inputError(path, "has no channel ", names[c], "; write R, G and B");
    for (std::size_t i = 0; i < texels; ++i) {
      const float value = (*plane)[i];
      if (!(value >= 0.0f && value <= maxMapValue))
        throw inputError(path, "channel ", names[c], " at pixel ", i % width, ", ", i / width,
                         " is not from 0 to 1e12; fix the map");
      map.rgb[3 * i + c] = value;
    }
  }
  return map;
}

} // namespace fenestra::core
