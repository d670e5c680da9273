#include "model/medium/Material.h"

#include "model/medium/Reflectance.h"

namespace fenestra::core {

std::optional<ColorFunction> toReflectanceColor(const Material& material) {
  if (!material.color || !material.colorIsAlbedo)
    return material.color;
  return material.color->withKnots([&](ColorFunction::Knot& knot) {
    knot.value =
        knot.value.unaryExpr([&](double albedo) { return toReflectance(albedo, material.g); });
  });
}

} // namespace fenestra::core
