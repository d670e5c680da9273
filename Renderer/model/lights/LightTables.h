#pragma once
// Placed lights for the formulas: float or double, in a space with world axes and mm.

#include "base/Vector.h"

#include <vector>

namespace fenestra::core {

template <typename Real>
struct LightTables {
  using Point = Vector<Real, 3>;
  using Color = Array<Real, 3>;

#include "formulas/LightTables.inl"

  std::vector<PlacedArea> areas;
  std::vector<PlacedSphere> spheres;
  std::vector<PlacedDirectional> directionals;
  std::vector<PlacedSky> skies;
  Color constant = Color::Zero(); ///< sum of all constant environments

  /// Calls visit(list) for each list of lights that are sampled.
  template <typename Tables, typename Visit>
  static void forEachSampled(Tables& tables, const Visit& visit) {
    visit(tables.directionals);
    visit(tables.areas);
    visit(tables.spheres);
  }

  /// Converts the tables to another number type, relative to `origin`.
  template <typename To>
  LightTables<To> cast(const Point& origin) const {
    LightTables<To> to;
    const auto number = [](Real x) { return static_cast<To>(x); };
    const auto three = [](const auto& x) { return x.template cast<To>(); };
    const auto point = [&](const Point& x) { return three(Point(x - origin)); };
    for (const PlacedArea& a : areas)
      to.areas.push_back({a.isDisk, point(a.center), three(a.normal), three(a.right), three(a.up),
                          number(a.perRight), number(a.perUp), number(a.area), three(a.radiance),
                          number(a.pmf)});
    for (const PlacedSphere& s : spheres)
      to.spheres.push_back({point(s.center), number(s.radius2), three(s.radiance), number(s.pmf)});
    for (const PlacedDirectional& d : directionals)
      to.directionals.push_back({three(d.toward), three(d.irradiance), number(d.pmf)});
    for (const PlacedSky& s : skies)
      to.skies.push_back({three(s.up), three(s.middle), three(s.toTop), three(s.toBottom)});
    to.constant = three(constant);
    return to;
  }
};

} // namespace fenestra::core
