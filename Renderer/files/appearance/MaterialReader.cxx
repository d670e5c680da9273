#include "files/appearance/MaterialReader.h"

#include "files/appearance/CurveReader.h"
#include "files/appearance/HexColor.h"
#include "io/MessageText.h"

#include <algorithm>

namespace fenestra::core {
namespace {

constexpr double maxPriority = 1000.0, maxInterfaceWeight = 10.0;
constexpr double maxDensity = 1000.0; ///< same limit as --density

// ---- materials

template <typename Value>
void readOptional(const JsonNode& object, const char* key, double low, double high, Value& value) {
  if (const auto node = object.find(key))
    value = node->number(low, high);
}

/// Reads "#rrggbb", or rows over the scalar.
ColorFunction readReflectance(const JsonNode& node) {
  if (node.isArray())
    return readColors(node);
  return ColorFunction({{0.0, readHexColor(node)}});
}

/// Reads three numbers, or rows over the scalar.
ColorFunction readAlbedo(const JsonNode& node) {
  const std::vector<JsonNode> parts = node.elements();
  if (parts.empty() || !parts.front().isNumber())
    return readCurve<3>(node, 1.0);
  return ColorFunction({{0.0, node.triple(0.0, 1.0).array()}});
}

/// Reads "base" (nullopt), a number per mm, or rows over the scalar.
std::optional<ScalarFunction> readExtinction(const JsonNode& node) {
  if (node.isArray())
    return readCurve<1>(node, maxMagnitude);
  if (node.isNumber())
    return ScalarFunction({{0.0, ScalarFunction::Value(node.number(0.0, maxMagnitude))}});
  if (!node.value().is_string() || node.text() != "base")
    throw node.error("must be \"base\", a number per mm, or [[scalar, number], …]");
  return std::nullopt;
}

void readKind(const JsonNode& object, Material& material) {
  const auto kind = object.find("kind"), extinction = object.find("extinction");
  if (extinction) {
    material.extinction = readExtinction(*extinction);
    if (material.extinction)
      material.kind = MaterialKind::medium;
  }
  if (kind)
    material.kind = static_cast<MaterialKind>(kind->choice({"tint", "matter"}));
  if (material.kind == MaterialKind::tint && material.extinction)
    throw kind->error("is \"tint\", which keeps the volume's extinction; remove \"extinction\" or "
                      "use \"matter\"");
}

/// Sets the members of a material that the object gives. "border" is the file's name of
/// Material::interfaceWeight.
void readMaterial(const JsonNode& object, Material& material) {
  ColorKind color = findColorKind(object);
  if (color == ColorKind::reflectance)
    material.color = readReflectance(object.at("color"));
  else if (color == ColorKind::albedo)
    material.color = readAlbedo(object.at("albedo"));
  if (color != ColorKind::none)
    material.colorIsAlbedo = color == ColorKind::albedo;
  else if (material.color)
    color = material.colorIsAlbedo ? ColorKind::albedo : ColorKind::reflectance;
  material.g = readMeanCosine(object, material.g, color);
  readKind(object, material);
  readOptional(object, "diffuse", 0.0, 1.0, material.diffuse);
  readOptional(object, "specular", 0.0, 1.0, material.specular);
  readOptional(object, "roughness", 0.05, 1.0, material.roughness);
  readOptional(object, "border", 0.0, maxInterfaceWeight, material.interfaceWeight);
}

// ---- rules

/// Reads an integer from low to high.
std::int32_t readInteger(const JsonNode& node, double low, double high) {
  const double value = node.number(low, high);
  if (value != std::floor(value))
    throw node.error("must be an integer");
  return static_cast<std::int32_t>(value);
}

/// Reads the name of a known material.
std::string readMaterialName(const JsonNode& node, const std::map<std::string, Material>& known) {
  constexpr std::size_t maxListed = 40;
  std::string name = node.text();
  if (!known.contains(name))
    throw node.error(
        "there is no material \"" + sanitize(name) + "\"; use one of \"materials\", or " +
        join(
            known, ", ", [](const auto& one) { return sanitize(one.first); }, maxListed));
  return name;
}

/// Sets priority, clipping and density of a segment or rule, if the object gives them.
template <typename Assignment>
void readAssignment(const JsonNode& object, Assignment& assignment) {
  if (const auto priority = object.find("priority"))
    assignment.priority = readInteger(*priority, 0.0, maxPriority);
  if (const auto clip = object.find("clip"))
    assignment.isClipped = clip->boolean();
  readOptional(object, "density", 0.0, maxDensity, assignment.density);
}

MaterialRule readRule(const JsonNode& node, const std::map<std::string, Material>& known) {
  constexpr double minValue = -2147483648.0, maxValue = 2147483647.0;
  node.allowOnly({"match", "material", "priority", "clip", "density"});
  const JsonNode match = node.at("match");
  match.allowOnly({"codes", "names", "except", "values", "category"});
  MaterialRule rule;
  rule.patterns = readPatterns(match);
  if (const auto category = match.find("category"))
    rule.category = readCode(*category);
  if (const auto values = match.find("values"))
    for (const JsonNode& value : values->elements()) {
      rule.values.push_back(readInteger(value, minValue, maxValue));
      if (rule.values.back() == 0)
        throw value.error("is 0, the background; use another value");
    }
  if (rule.patterns.codes.empty() && rule.patterns.names.empty() && rule.values.empty() &&
      rule.category.empty())
    throw match.error("has no \"codes\", \"names\", \"values\" or \"category\"; add one to select "
                      "segments");
  rule.material = readMaterialName(node.at("material"), known);
  rule.isFromFile = true;
  readAssignment(node, rule);
  return rule;
}

ContextColors readContext(const JsonNode& node) {
  node.allowOnly({"saturation", "lightness"});
  ContextColors context;
  readOptional(node, "saturation", 0.0, 1.0, context.saturation);
  readOptional(node, "lightness", 0.0, 1.0, context.lightness);
  return context;
}

// ---- changes

/// Converts the value of "key=value" to JSON: boolean for yes or no, number, or string.
nlohmann::json toJsonValue(const std::string& text) {
  if (const auto number = parseNumber<double>(text))
    return *number;
  if (text == "yes" || text == "no")
    return text == "yes";
  return text;
}

void applyFields(const JsonNode& fields, const MaterialTable& table, SegmentMedium& medium) {
  fields.allowOnly({"material", "color", "albedo", "extinction", "g", "kind", "diffuse", "specular",
                    "roughness", "border", "priority", "clip", "density"});
  if (const auto name = fields.find("material"))
    medium.material = table.materials.at(readMaterialName(*name, table.materials));
  readMaterial(fields, medium.material);
  readAssignment(fields, medium);
}

std::string describeSource(const MaterialChange& change) {
  return "material " + sanitize(change.selector);
}

} // namespace

MaterialTable parseMaterials(std::string_view json, const std::string& source,
                             const MaterialTable& base) {
  const nlohmann::json document = parseJson(json, source);
  const JsonNode root(document, source);
  root.allowOnly({"version", "materials", "segments", "rest", "context", "contrast"});
  if (const JsonNode version = root.at("version"); version.number() != 1.0)
    throw version.error("must be 1, the version that this Fenestra reads");
  MaterialTable table = base;
  std::ranges::for_each(table.rules, [](MaterialRule& rule) { rule.isFromFile = false; });
  if (const auto materials = root.find("materials"))
    for (const auto& [name, node] : materials->members()) {
      node.allowOnly({"color", "albedo", "extinction", "g", "kind", "diffuse", "specular",
                      "roughness", "border"});
      readMaterial(node, table.materials[name] = {});
    }
  if (const auto segments = root.find("segments")) {
    std::vector<MaterialRule> fileRules;
    for (const JsonNode& node : segments->elements())
      fileRules.push_back(readRule(node, table.materials));
    table.rules.insert(table.rules.begin(), fileRules.begin(), fileRules.end());
  }
  if (const auto rest = root.find("rest")) {
    rest->allowOnly({"material"});
    table.rest = readMaterialName(rest->at("material"), table.materials);
  }
  if (const auto context = root.find("context"))
    table.context = readContext(*context);
  if (const auto contrast = root.find("contrast"))
    table.hasContrast = contrast->boolean();
  return table;
}

MaterialChange parseMaterialChange(const std::string& text, const MaterialTable& table) {
  const std::size_t colon = text.rfind(':');
  MaterialChange change{std::string(trim(text.substr(0, std::min(colon, text.size())))),
                        nlohmann::json::object()};
  if (colon == std::string::npos || change.selector.empty())
    throw inputError(ErrorCode::invalidField, "material " + sanitize(text),
                     "must give a segment and what to change, as in \"Liver: color=#963e2e\"");
  for (const std::string& field : split(toOneLine(text.substr(colon + 1)), ',')) {
    const std::size_t equals = field.find('=');
    const std::string key(trim(field.substr(0, std::min(equals, field.size()))));
    if (equals == std::string::npos || key.empty())
      throw inputError(describeSource(change), "\"", sanitize(field),
                       "\" must be a key and a value, as in ", "density=2");
    if (change.fields.contains(key))
      throw inputError(describeSource(change), sanitize(key), ": is given twice; remove one");
    change.fields[key] = toJsonValue(std::string(trim(field.substr(equals + 1))));
  }
  if (change.fields.empty())
    throw inputError(describeSource(change),
                     "changes nothing; add a key and a value, as in density=2");
  applyChange({}, change, table);
  return change;
}

SegmentMedium applyChange(const SegmentMedium& medium, const MaterialChange& change,
                          const MaterialTable& table) {
  SegmentMedium result = medium;
  applyFields(JsonNode(change.fields, describeSource(change)), table, result);
  return result;
}

} // namespace fenestra::core
