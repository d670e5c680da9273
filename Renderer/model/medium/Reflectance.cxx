#include "model/medium/Reflectance.h"

#include "model/medium/ReflectanceTable.h"

namespace fenestra::core {
namespace {

/// Reflectance by similarity parameter s = sqrt((1 - a) / (1 - g a)): media of different g and
/// equal s look nearly alike (van de Hulst 1980). Closed form for g = 0, corrected by the table.
double lookUpReflectance(double s, double g) {
  using namespace reflectanceTable;
  const double row = std::clamp(g / maxReflectanceG, 0.0, 1.0) * (rows - 1),
               column = s * (columns - 1);
  const int r = std::min(static_cast<int>(row), rows - 2);
  const int c = std::min(static_cast<int>(column), columns - 2);
  const auto across = [&](int tableRow) {
    const double left = static_cast<double>(ratios[tableRow][c]),
                 right = static_cast<double>(ratios[tableRow][c + 1]);
    return left + (column - c) * (right - left);
  };
  const double ratio = across(r) + (row - r) * (across(r + 1) - across(r));
  return ratio * (1.0 - s) / (1.0 + 2.0 * s);
}

} // namespace

double toReflectance(double albedo, double g) {
  const double a = std::clamp(albedo, 0.0, 1.0), forward = std::clamp(g, 0.0, maxReflectanceG);
  return lookUpReflectance(std::sqrt((1.0 - a) / (1.0 - forward * a)), forward);
}

double toAlbedo(double color, double g) {
  const double wanted = std::clamp(color, 0.0, maxReflectance);
  const double forward = std::clamp(g, 0.0, maxReflectanceG);
  double least = 0.0, greatest = 1.0; // bounds of s; the reflectance decreases with s
  for (int i = 0; i < 50; ++i) {
    const double s = 0.5 * (least + greatest);
    (lookUpReflectance(s, forward) > wanted ? least : greatest) = s;
  }
  const double s2 = greatest * greatest;
  return (1.0 - s2) / (1.0 - forward * s2);
}

ColorFunction toAlbedo(const ColorFunction& colors, double g) {
  constexpr int steps = 16;
  const auto& given = colors.knots();
  std::vector<ColorFunction::Knot> knots;
  for (std::size_t i = 0; i + 1 < given.size(); ++i) {
    const double from = given[i].position, to = given[i + 1].position;
    for (int k = 0; k < (to > from ? steps : 1); ++k) {
      const double fraction = static_cast<double>(k) / steps;
      const Rgb color = given[i].value + fraction * (given[i + 1].value - given[i].value);
      knots.push_back({from + fraction * (to - from), toAlbedo(color, g)});
    }
  }
  knots.push_back({given.back().position, toAlbedo(given.back().value, g)});
  return ColorFunction(std::move(knots));
}

} // namespace fenestra::core
