#include "phantoms/Anatomy.h"

#include "io/EmbeddedResources.h"

namespace fenestra::core {

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

Solid makeShape(const Anatomy& part) {
  if (part.contains("ellipsoid"))
    return makeEllipsoid(part["ellipsoid"].at(0), part["ellipsoid"].at(1));
  if (part.contains("block"))
    return makeBlock(part["block"], part.at("rounding"));
  if (part.contains("loft"))
    return makeLoft(part["loft"], part.value("squareness", 0.25), part.value("cap", 5.0));
  if (part.contains("tube"))
    return makeTube(part["tube"], part.value("stretch", Vec3(Vec3::Ones())));
  if (part.contains("parts"))
    return part["parts"];
  const double floor = part.at("above");
  return {[floor](const Vec3& p) { return floor - p.z(); },
          {{-infinity, -infinity, floor}, Vec3::Constant(infinity)}};
}

Solid makePlacedShape(const Anatomy& part) {
  Solid solid = makeShape(part);
  if (part.contains("frame"))
    solid =
        placeSolid(toShape(part["frame"].at(0), part["frame"].at(1), part["frame"].at(2)), solid);
  return part.value("paired", false) ? mirrorPair(solid) : solid;
}

Solid combineSolids(const Solid& before, const Anatomy& part) {
  const Solid solid = makePlacedShape(part);
  if (part.contains("cut"))
    return subtract(before, solid, part["cut"]);
  if (part.contains("intersect"))
    return intersect(before, solid, part["intersect"]);
  return unite(before, solid, part.at("unite"));
}

} // namespace

Anatomy loadAnatomy(const std::string& subject) {
  return Anatomy::parse(findResource("phantoms/" + subject + ".json"));
}

void from_json(const Anatomy& parts, Solid& solid) {
  if (!parts.is_array()) {
    solid = makePlacedShape(parts);
    return;
  }
  solid = makePlacedShape(parts.at(0));
  for (std::size_t i = 1; i < parts.size(); ++i)
    solid = combineSolids(solid, parts[i]);
}

} // namespace fenestra::core
