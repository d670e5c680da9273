#pragma once
// Style of the context, to set off the focus: thinner or paler. (Viola, Kanitsar, Groeller 2005,
// "Importance-Driven Feature Enhancement in Volume Visualization".)

#include "base/Color.h"
#include "model/volume/Mask.h"
#include "model/volume/Volume.h"

#include <memory>

namespace fenestra {

/// Look of the context, where the focus's indicator is below 1/2. The focus is unchanged.
struct ContextStyle {
  std::shared_ptr<const Mask> focus; ///< at least four voxels
  double extinction = 1.0;           ///< multiplies the extinction, 0 to 1
  double saturation = 1.0;           ///< of the albedo; 0: grey, 1: unchanged

  /// Albedo of reduced saturation and unchanged luminance.
  Rgb desaturate(const Rgb& albedo) const {
    const double gray = luminance(albedo);
    return gray + saturation * (albedo - gray);
  }
};

/// Tests a volume's points for a style's focus. A view: the style must outlive the object.
class ContextField {
public:
  ContextField(const ContextStyle& style, const Grid& volume)
      : m_style(style),
        m_toMask(style.focus->grid.worldToIndex * volume.indexToWorld),
        m_field(style.focus->grid, style.focus->voxels),
        m_level(0.5 * style.focus->maxValue) {}

  const ContextStyle& style() const { return m_style; }
  /// True if a point (the volume's index space) lies in the focus: indicator >= 1/2. Beyond the
  /// mask the outermost voxels repeat.
  bool isFocus(const Vec3& index) const { return m_field.value(m_toMask * index) >= m_level; }

private:
  const ContextStyle& m_style;
  Affine m_toMask;
  Field<std::uint8_t> m_field;
  double m_level;
};

} // namespace fenestra
