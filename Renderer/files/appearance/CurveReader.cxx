#include "files/appearance/CurveReader.h"

#include "files/appearance/HexColor.h"
#include "model/medium/Reflectance.h"

#include <algorithm>
#include <span>

namespace fenestra::core {

double readFinite(const JsonNode& node) {
  return node.number(-maxMagnitude, maxMagnitude);
}

template <int Channels>
PiecewiseLinear<Channels> readCurve(const JsonNode& rows, double maxValue) {
  std::vector<typename PiecewiseLinear<Channels>::Knot> knots;
  for (const JsonNode& row : rows.elements()) {
    const auto numbers = row.numbers(Channels + 1, -maxMagnitude, maxMagnitude);
    for (const double value : std::span(numbers).subspan(1))
      if (value < 0.0 || value > maxValue)
        throw row.error(maxValue == 1.0 ? "values must be from 0 to 1"
                                        : "value must not be negative");
    Array<double, Channels> value;
    std::copy_n(numbers.begin() + 1, Channels, value.data());
    knots.push_back({numbers[0], value});
  }
  if (knots.empty())
    throw rows.error("is empty; give at least one point");
  return PiecewiseLinear<Channels>(std::move(knots));
}

template ScalarFunction readCurve<1>(const JsonNode&, double);
template ColorFunction readCurve<3>(const JsonNode&, double);

ColorFunction readColors(const JsonNode& rows) {
  constexpr std::size_t maxColors = 4096;
  std::vector<ColorFunction::Knot> colors;
  for (const JsonNode& row : rows.elements()) {
    const std::vector<JsonNode> parts = row.elements();
    if (parts.size() != 2)
      throw row.error("must be [scalar, \"#rrggbb\"]");
    colors.push_back({readFinite(parts[0]), readHexColor(parts[1])});
  }
  if (colors.empty() || colors.size() > maxColors)
    throw rows.error(concat("has ", colors.size(), " points; give 1 to ", maxColors));
  return ColorFunction(std::move(colors));
}

ColorKind findColorKind(const JsonNode& object) {
  const auto color = object.find("color");
  const bool hasAlbedo = object.find("albedo").has_value();
  if (color && hasAlbedo)
    throw color->error("cannot be combined with \"albedo\"; give one of them");
  return color ? ColorKind::reflectance : hasAlbedo ? ColorKind::albedo : ColorKind::none;
}

double readMeanCosine(const JsonNode& object, double fallback, ColorKind kind) {
  const auto node = object.find("g");
  const double g = node ? node->number() : fallback;
  if (!(std::abs(g) < 1.0))
    throw node->error("must be between -1 and 1, exclusive");
  if (kind == ColorKind::reflectance && !(g >= 0.0 && g <= maxReflectanceG))
    throw object.at("g").error(
        concat("must be from 0 to ", toString(maxReflectanceG), " with \"color\""));
  return g;
}

} // namespace fenestra::core
