#include "files/appearance/TransferReader.h"

#include "files/appearance/CurveReader.h"
#include "io/InputRegistry.h"
#include "io/JsonNode.h"
#include "model/medium/Reflectance.h"
#include "model/medium/VolumeProperty.h"

namespace fenestra::core {
namespace {

constexpr double maxAnisotropy = 0.999; ///< maximum |g|; at 1, directions would never change

// ---- Fenestra's .json

/// Surface lobes: a coat if color, specular or roughness is given; otherwise those of Slicer's
/// default material.
std::optional<SurfaceShading> readShading(const JsonNode& root, double g) {
  const auto specular = root.find("specular"), roughness = root.find("roughness");
  const auto shading = root.find("shading");
  if (!shading || shading->choice({"volume", "hybrid"}) == 0) {
    if (const auto& lobe = specular ? specular : roughness)
      throw lobe->error("applies to surfaces only; add \"shading\": \"hybrid\"");
    return std::nullopt;
  }
  if (!specular && !roughness && !root.find("color"))
    return SurfaceShading();
  return SurfaceShading::makeCoated(specular ? specular->number(0.0, 1.0) : 0.2,
                                    roughness ? roughness->number(0.05, 1.0) : 0.4, g);
}

TransferFile readFenestraJson(const JsonNode& root) {
  root.allowOnly({"scalars", "extinction", "albedo", "color", "g", "shading", "specular",
                  "roughness", "islands"});
  const ColorKind kind = findColorKind(root);
  const double g = readMeanCosine(root, 0.0, kind);
  ScalarFunction extinction = readCurve<1>(root.at("extinction"), maxMagnitude);
  if (kind == ColorKind::none)
    throw root.error("has neither \"albedo\" nor \"color\"; give one of them");
  TransferFunction transfer{std::move(extinction), kind == ColorKind::reflectance
                                                       ? toAlbedo(readColors(root.at("color")), g)
                                                       : readCurve<3>(root.at("albedo"), 1.0)};
  transfer.g = g;
  transfer.shading = readShading(root, g);
  const auto scalars = root.find("scalars");
  const std::size_t unit = scalars ? scalars->choice({"absolute", "relative", "tissues"}) : 0;
  TransferFile file{std::move(transfer), static_cast<TransferFile::Scalars>(unit)};
  if (const auto islands = root.find("islands"))
    file.islands = islands->number(0.0, maxMagnitude);
  return file;
}

// ---- Slicer's .vp.json

/// Sets `value` if the member exists.
void readOptional(const JsonNode& parent, const std::string& key, double& value) {
  if (const auto node = parent.find(key))
    value = readFinite(*node);
}

/// Reads the points of a function, sorted by x.
template <typename Node>
std::vector<Node> readPoints(const JsonNode& function) {
  std::vector<Node> nodes;
  for (const JsonNode& point : function.at("points").elements()) {
    Node& node = nodes.emplace_back();
    node.x = readFinite(point.at("x"));
    readOptional(point, "midpoint", node.midpoint);
    readOptional(point, "sharpness", node.sharpness);
    if constexpr (std::is_same_v<Node, OpacityNode>)
      node.value = point.at("y").number(0.0, 1.0);
    else
      node.value = point.at("color").triple(0.0, 1.0).array();
  }
  std::ranges::stable_sort(nodes, {}, &Node::x);
  return nodes;
}

JsonNode readFirst(const JsonNode& parent, const std::string& key) {
  const JsonNode array = parent.at(key);
  const std::vector<JsonNode> elements = array.elements();
  if (elements.empty())
    throw array.error("is empty; save the volume property again");
  return elements.front();
}

VolumeProperty readVpJson(const JsonNode& root) {
  const JsonNode slicer = readFirst(root, "volumeProperties");
  const JsonNode component = readFirst(slicer, "components");
  VolumeProperty property;
  property.scalarOpacity = readPoints<OpacityNode>(component.at("scalarOpacity"));
  property.color = readPoints<ColorNode>(component.at("rgbTransferFunction"));
  const auto disabled = component.find("disableGradientOpacity");
  const auto gradient = component.find("gradientOpacity");
  if (gradient && !(disabled && disabled->boolean()))
    property.gradientOpacity = readPoints<OpacityNode>(*gradient);
  readOptional(component, "scalarOpacityUnitDistance", property.unitDistance);
  if (const auto shade = component.find("shade"))
    property.shade = shade->boolean();
  if (const auto lighting = component.find("lighting")) {
    readOptional(*lighting, "diffuse", property.diffuse);
    readOptional(*lighting, "specular", property.specular);
    readOptional(*lighting, "specularPower", property.specularPower);
  }
  if (const auto g = slicer.find("scatteringAnisotropy"))
    property.anisotropy = std::clamp(g->number(-1.0, 1.0), -maxAnisotropy, maxAnisotropy);
  return property;
}

// ---- Slicer's .vp, and the same strings as attributes of a scene node

/// MRML attribute names of a property, in the order of the lines of a .vp.
constexpr const char* propertyFields[] = {"interpolation", "shade",           "diffuse",
                                          "ambient",       "specular",        "specularPower",
                                          "scalarOpacity", "gradientOpacity", "colorTransfer"};

enum class PropertyForm { lines, attributes };

class PropertyFields {
public:
  PropertyFields(const std::map<std::string, std::string>& texts, PropertyForm form,
                 std::string source)
      : m_texts(texts), m_form(form), m_source(std::move(source)) {}

  bool has(const std::string& field) const { return m_texts.contains(field); }

  double number(const std::string& field) const {
    const auto all = numbers(field);
    if (all.size() != 1)
      throw error(field, "must be one number");
    return all[0];
  }

  /// Parses `<count> x v... x v...` into rows of `width` numbers. An x below the previous
  /// one is raised to it, since Slicer shifts equal x by 10 units in the last place.
  std::vector<std::vector<double>> rows(const std::string& field, std::size_t width) const {
    const auto all = numbers(field);
    if (all.empty() || all[0] != static_cast<double>(all.size() - 1) ||
        (all.size() - 1) % width != 0)
      throw error(field, concat("must be a count and that many numbers, ", width, " per point"));
    std::vector<std::vector<double>> rows;
    for (auto it = all.begin() + 1; it != all.end(); it += static_cast<long>(width)) {
      rows.emplace_back(it, it + static_cast<long>(width));
      if (rows.size() > 1)
        rows.back()[0] = std::max(rows.back()[0], rows[rows.size() - 2][0]);
    }
    return rows;
  }

private:
  Error error(const std::string& field, const std::string& what) const {
    if (m_form == PropertyForm::attributes)
      return fieldError(m_source, field, what);
    const auto* const line = std::find(std::begin(propertyFields), std::end(propertyFields), field);
    return fieldError(
        m_source, concat("line ", line - std::begin(propertyFields) + 1, " (", field, ")"), what);
  }

  std::vector<double> numbers(const std::string& field) const {
    const auto text = m_texts.find(field);
    if (text == m_texts.end())
      throw error(field, "is missing; save the volume property again");
    auto all = parseNumbers(text->second);
    if (!all || std::any_of(all->begin(), all->end(),
                            [](double x) { return !(std::abs(x) <= maxMagnitude); }))
      throw error(field, "has text that is not a number; save the volume property again");
    return std::move(*all);
  }

  const std::map<std::string, std::string>& m_texts;
  PropertyForm m_form;
  std::string m_source;
};

/// Reads all fields but ambient light, which path tracing does not have.
VolumeProperty readProperty(const PropertyFields& texts) {
  VolumeProperty property;
  if (texts.has("shade"))
    property.shade = texts.number("shade") != 0.0;
  const std::pair<const char*, double*> numbers[] = {{"diffuse", &property.diffuse},
                                                     {"specular", &property.specular},
                                                     {"specularPower", &property.specularPower}};
  for (const auto& [field, value] : numbers)
    if (texts.has(field))
      *value = texts.number(field);
  for (const auto& row : texts.rows("scalarOpacity", 2))
    property.scalarOpacity.push_back({row[0], row[1]});
  if (texts.has("gradientOpacity"))
    for (const auto& row : texts.rows("gradientOpacity", 2))
      property.gradientOpacity.push_back({row[0], row[1]});
  for (const auto& row : texts.rows("colorTransfer", 4))
    property.color.push_back({row[0], {row[1], row[2], row[3]}});
  return property;
}

VolumeProperty readVp(std::string_view content, const std::string& source) {
  std::vector<std::string> lines = split(content, '\n');
  lines.resize(std::size(propertyFields));
  std::map<std::string, std::string> texts;
  for (std::size_t i = 0; i < lines.size(); ++i)
    texts[propertyFields[i]] = lines[i];
  const PropertyFields property(texts, PropertyForm::lines, source);
  for (const char* field : {"interpolation", "ambient"}) // unused, but required by the format
    property.number(field);
  return readProperty(property);
}

} // namespace

TransferFunction TransferFile::mapScalars(std::span<const double> anchors) const {
  const auto mapPosition = [&](auto& knot) {
    const double last = static_cast<double>(anchors.size() - 2);
    const auto i = static_cast<std::size_t>(std::clamp(std::floor(knot.position), 0.0, last));
    const double fraction = knot.position - static_cast<double>(i);
    knot.position = anchors[i] + fraction * (anchors[i + 1] - anchors[i]);
  };
  TransferFunction result = function;
  result.extinction = function.extinction.withKnots(mapPosition);
  result.albedo = function.albedo.withKnots(mapPosition);
  return result;
}

TransferFile parseTransferJson(std::string_view json, const std::string& source) {
  const nlohmann::json document = parseJson(json, source);
  const JsonNode root(document, source);
  if (root.find("volumeProperties"))
    return {tabulate(readVpJson(root), source)};
  return readFenestraJson(root);
}

TransferFunction parseTransferFunction(const std::map<std::string, std::string>& attributes,
                                       const std::string& source) {
  return tabulate(readProperty(PropertyFields(attributes, PropertyForm::attributes, source)),
                  source);
}

TransferFile readTransferFile(const std::filesystem::path& path) {
  const std::string source = path.string();
  const std::string extension = lowercaseExtension(path);
  if (extension != ".vp" && extension != ".json")
    throw inputError(ErrorCode::unsupportedFile, source,
                     "is not a transfer function; give a .vp, .vp.json or .json file");
  const std::string text = readText(path);
  return extension == ".vp" ? TransferFile{tabulate(readVp(text, source), source)}
                            : parseTransferJson(text, source);
}

TransferFunction readTransferFunction(const std::filesystem::path& path) {
  TransferFile file = readTransferFile(path);
  if (file.scalars != TransferFile::Scalars::absolute)
    throw fieldError(path, "scalars",
                     "are relative to a volume; give a file with absolute scalars");
  return std::move(file.function);
}

} // namespace fenestra::core
