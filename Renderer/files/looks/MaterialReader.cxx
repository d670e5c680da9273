#include "files/looks/MaterialReader.h"

#include "base/safe/ShownText.h"
#include "files/looks/CurveReader.h"
#include "files/looks/HexColor.h"

#include <algorithm>

namespace fenestra {
namespace {

constexpr double highestPriority = 1000.0, greatestBorder = 10.0;
constexpr double greatestDensity = 1000.0; ///< as --density

// ---- materials

template <typename Value>
void readIfThere(const JsonNode& object, const char* key, double low, double high, Value& value) {
  if (const auto node = object.find(key))
    value = node->number(low, high);
}

/// "#rrggbb", or rows over the scalar.
ColorFunction readSeen(const JsonNode& node) {
  if (node.isArray())
    return readColors(node);
  return ColorFunction({{0.0, readHexColor(node)}});
}

/// Three numbers, or rows over the scalar.
ColorFunction readAlbedo(const JsonNode& node) {
  const std::vector<JsonNode> parts = node.elements();
  if (parts.empty() || !parts.front().isNumber())
    return readCurve<3>(node, 1.0);
  return ColorFunction({{0.0, node.triple(0.0, 1.0).array()}});
}

/// "base", a number per mm, or rows over the scalar.
std::optional<ScalarFunction> readExtinction(const JsonNode& node) {
  if (node.isArray())
    return readCurve<1>(node, largestValue);
  if (node.isNumber())
    return ScalarFunction({{0.0, ScalarFunction::Value(node.number(0.0, largestValue))}});
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
    throw kind->error("is \"tint\", which keeps the volume's extinction; leave out \"extinction\", "
                      "or make it \"matter\"");
}

/// Sets what the object says of a material.
void readMaterial(const JsonNode& object, Material& material) {
  ColorKind color = colorKind(object);
  if (color == ColorKind::seen)
    material.color = readSeen(object.at("color"));
  else if (color == ColorKind::albedo)
    material.color = readAlbedo(object.at("albedo"));
  if (color != ColorKind::none)
    material.colorIsAlbedo = color == ColorKind::albedo;
  else if (material.color)
    color = material.colorIsAlbedo ? ColorKind::albedo : ColorKind::seen;
  material.g = readMeanCosine(object, material.g, color);
  readKind(object, material);
  readIfThere(object, "diffuse", 0.0, 1.0, material.diffuse);
  readIfThere(object, "specular", 0.0, 1.0, material.specular);
  readIfThere(object, "roughness", 0.05, 1.0, material.roughness);
  readIfThere(object, "border", 0.0, greatestBorder, material.interfaceWeight);
}

// ---- rules

/// A whole number from low to high.
std::int32_t readWhole(const JsonNode& node, double low, double high) {
  const double value = node.number(low, high);
  if (value != std::floor(value))
    throw node.error("must be a whole number");
  return static_cast<std::int32_t>(value);
}

/// Name of a material, which must be there.
std::string readMaterialName(const JsonNode& node, const std::map<std::string, Material>& known) {
  constexpr std::size_t mostListed = 40;
  std::string name = node.text();
  if (!known.contains(name))
    throw node.error(
        "there is no material \"" + sanitize(name) + "\"; name one of \"materials\", or of " +
        join(
            known, ", ", [](const auto& one) { return sanitize(one.first); }, mostListed));
  return name;
}

/// Sets what the object says of a segment's use of its material.
template <typename Use>
void readUse(const JsonNode& object, Use& use) {
  if (const auto priority = object.find("priority"))
    use.priority = readWhole(*priority, 0.0, highestPriority);
  if (const auto clip = object.find("clip"))
    use.isClipped = clip->boolean();
  readIfThere(object, "density", 0.0, greatestDensity, use.density);
}

MaterialRule readRule(const JsonNode& node, const std::map<std::string, Material>& known) {
  constexpr double least = -2147483648.0, greatest = 2147483647.0;
  node.allowOnly({"match", "material", "priority", "clip", "density"});
  const JsonNode match = node.at("match");
  match.allowOnly({"codes", "names", "except", "values", "category"});
  MaterialRule rule;
  rule.patterns = readPatterns(match);
  if (const auto category = match.find("category"))
    rule.category = readCode(*category);
  if (const auto values = match.find("values"))
    for (const JsonNode& value : values->elements()) {
      rule.values.push_back(readWhole(value, least, greatest));
      if (rule.values.back() == 0)
        throw value.error("is 0, which is the background; name another value");
    }
  if (rule.patterns.codes.empty() && rule.patterns.names.empty() && rule.values.empty() &&
      rule.category.empty())
    throw match.error("has no \"codes\", \"names\", \"values\" or \"category\"; say which segments "
                      "are meant");
  rule.material = readMaterialName(node.at("material"), known);
  rule.isOwn = true;
  readUse(node, rule);
  return rule;
}

ContextColors readContext(const JsonNode& node) {
  node.allowOnly({"saturation", "lightness"});
  ContextColors context;
  readIfThere(node, "saturation", 0.0, 1.0, context.saturation);
  readIfThere(node, "lightness", 0.0, 1.0, context.lightness);
  return context;
}

// ---- changes

/// Value of "key=value" as JSON: yes, no, a number, or a text.
nlohmann::json valueOf(const std::string& text) {
  if (const auto number = parseNumber<double>(text))
    return *number;
  if (text == "yes" || text == "no")
    return text == "yes";
  return text;
}

void apply(const JsonNode& fields, const MaterialTable& table, SegmentMedium& medium) {
  fields.allowOnly({"material", "color", "albedo", "extinction", "g", "kind", "diffuse", "specular",
                    "roughness", "border", "priority", "clip", "density"});
  if (const auto name = fields.find("material"))
    medium.material = table.materials.at(readMaterialName(*name, table.materials));
  readMaterial(fields, medium.material);
  readUse(fields, medium);
}

std::string sourceOf(const MaterialChange& change) {
  return "--material " + sanitize(change.selector);
}

} // namespace

MaterialTable parseMaterials(std::string_view json, const std::string& source,
                             const MaterialTable& beneath) {
  const nlohmann::json document = parseJson(json, source);
  const JsonNode root(document, source);
  root.allowOnly({"version", "materials", "segments", "rest", "context", "contrast"});
  if (const JsonNode version = root.at("version"); version.number() != 1.0)
    throw version.error("must be 1, which is the form that this Fenestra reads");
  MaterialTable table = beneath;
  std::ranges::for_each(table.rules, [](MaterialRule& rule) { rule.isOwn = false; });
  if (const auto materials = root.find("materials"))
    for (const auto& [name, node] : materials->members()) {
      node.allowOnly({"color", "albedo", "extinction", "g", "kind", "diffuse", "specular",
                      "roughness", "border"});
      readMaterial(node, table.materials[name] = {});
    }
  if (const auto segments = root.find("segments")) {
    std::vector<MaterialRule> own;
    for (const JsonNode& node : segments->elements())
      own.push_back(readRule(node, table.materials));
    table.rules.insert(table.rules.begin(), own.begin(), own.end());
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
    throw inputError("--material " + sanitize(text),
                     "must name a segment and what to change, as in \"Liver: color=#963e2e\"");
  for (const std::string& field : split(toOneLine(text.substr(colon + 1)), ',')) {
    const std::size_t equals = field.find('=');
    const std::string key(trim(field.substr(0, std::min(equals, field.size()))));
    if (equals == std::string::npos || key.empty())
      throw inputError(sourceOf(change), "\"", sanitize(field),
                       "\" must be a key and a value, as in ", "density=2");
    if (change.fields.contains(key))
      throw inputError(sourceOf(change), sanitize(key), ": is given twice; give one");
    change.fields[key] = valueOf(std::string(trim(field.substr(equals + 1))));
  }
  if (change.fields.empty())
    throw inputError(sourceOf(change), "changes nothing; add a key and a value, as in density=2");
  changed({}, change, table);
  return change;
}

SegmentMedium changed(const SegmentMedium& medium, const MaterialChange& change,
                      const MaterialTable& table) {
  SegmentMedium result = medium;
  apply(JsonNode(change.fields, sourceOf(change)), table, result);
  return result;
}

} // namespace fenestra
