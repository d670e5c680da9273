#include "phantoms/Anatomy.h"

#include "base/safe/EmbeddedResources.h"

namespace fenestra {

void from_json(const Anatomy& numbers, Vec2& vector) {
  vector = {numbers.at(0).get<double>(), numbers.at(1).get<double>()};
}

void from_json(const Anatomy& numbers, Vec3& vector) {
  vector = {numbers.at(0).get<double>(), numbers.at(1).get<double>(), numbers.at(2).get<double>()};
}

static void from_json(const Anatomy& numbers, LoftSection& section) {
  const auto [z, x, y, across, along] = numbers.get<std::array<double, 5>>();
  section = {z, {x, y}, {across, along}};
}

static void from_json(const Anatomy& numbers, TubeNode& node) {
  node = {numbers.get<Vec3>(), numbers.at(3).get<double>()};
}

namespace {

Solid shapeOf(const Anatomy& part) {
  if (part.contains("ellipsoid"))
    return ellipsoid(part["ellipsoid"].at(0), part["ellipsoid"].at(1));
  if (part.contains("block"))
    return block(part["block"], part.at("rounding"));
  if (part.contains("loft"))
    return loft(part["loft"], part.value("squareness", 0.25), part.value("cap", 5.0));
  if (part.contains("tube"))
    return tube(part["tube"], part.value("stretch", Vec3(Vec3::Ones())));
  if (part.contains("parts"))
    return part["parts"];
  const double floor = part.at("above");
  return {[floor](const Vec3& p) { return floor - p.z(); },
          {{-infinity, -infinity, floor}, Vec3::Constant(infinity)}};
}

Solid placedShapeOf(const Anatomy& part) {
  Solid solid = shapeOf(part);
  if (part.contains("frame"))
    solid = placed(toShape(part["frame"].at(0), part["frame"].at(1), part["frame"].at(2)), solid);
  return part.value("paired", false) ? paired(solid) : solid;
}

Solid joined(const Solid& before, const Anatomy& part) {
  const Solid solid = placedShapeOf(part);
  if (part.contains("cut"))
    return without(before, solid, part["cut"]);
  if (part.contains("intersect"))
    return intersect(before, solid, part["intersect"]);
  return unite(before, solid, part.at("unite"));
}

} // namespace

Anatomy anatomyOf(const std::string& subject) {
  return Anatomy::parse(findResource("phantoms/" + subject + ".json"));
}

void from_json(const Anatomy& parts, Solid& solid) {
  if (!parts.is_array()) {
    solid = placedShapeOf(parts);
    return;
  }
  solid = placedShapeOf(parts.at(0));
  for (std::size_t i = 1; i < parts.size(); ++i)
    solid = joined(solid, parts[i]);
}

} // namespace fenestra
