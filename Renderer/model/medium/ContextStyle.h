#pragma once
// Style that makes the context less prominent than the focus: lower extinction and saturation
// (Viola, Kanitsar, Groeller 2005, "Importance-Driven Feature Enhancement in Volume
// Visualization"). It changes the medium, not the clip.

#include "base/Color.h"
#include "model/volume/Field.h"
#include "model/volume/Mask.h"

#include <memory>

namespace fenestra::core {

/// Applies where the focus's indicator is below 1/2. The focus is unchanged.
struct ContextStyle {
  std::shared_ptr<const Mask> focus; ///< at least four voxels
  double extinction = 1.0;           ///< factor on the extinction, 0 to 1
  double saturation = 1.0;           ///< factor on the albedo's saturation; 0: gray, 1: unchanged

  /// Albedo of reduced saturation and unchanged luminance.
  Rgb desaturate(const Rgb& albedo) const {
    const double gray = luminance(albedo);
    return gray + saturation * (albedo - gray);
  }
};

/// Evaluates a style at points of a volume. A view: the style must outlive it.
class ContextField {
public:
  ContextField(const ContextStyle& style, const Grid& volume)
      : m_style(style),
        m_toMask(style.focus->grid.worldToIndex * volume.indexToWorld),
        m_field(style.focus->grid, style.focus->voxels),
        m_level(0.5 * style.focus->maxValue) {}

  const ContextStyle& style() const { return m_style; }
  /// True if a point (the volume's index space) lies in the focus: indicator >= 1/2. Outside the
  /// mask's grid the nearest voxel is used.
  bool isFocus(const Vec3& index) const { return m_field.value(m_toMask * index) >= m_level; }

private:
  const ContextStyle& m_style;
  Affine m_toMask;
  Field<std::uint8_t> m_field;
  double m_level;
};

} // namespace fenestra::core
