#pragma once
// Focus and context told apart by how they look: what is not focus is thinner or paler. (Viola,
// Kanitsar, Groeller 2005, "Importance-Driven Feature Enhancement in Volume Visualization".)

#include "model/volume/Mask.h"
#include "model/volume/Volume.h"

#include <memory>

namespace fenestra {

/// Of linear Rec. 709.
inline double luminance(const Rgb& color) {
  return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
}

/// What lies outside the focus, whose indicator is below 0.5 there, looks like. The focus is
/// untouched.
struct ContextStyle {
  std::shared_ptr<const Mask> focus; ///< at least four voxels
  double extinction = 1.0;           ///< multiplies the extinction, 0 to 1
  double saturation = 1.0;           ///< of the albedo: 0 is grey, 1 as it is

  /// With less colour, and the same luminance.
  Rgb paled(const Rgb& albedo) const {
    const double grey = luminance(albedo);
    return grey + saturation * (albedo - grey);
  }
};

/// Where a volume's points lie in a style's focus. A view: the style outlives it.
class StyledContext {
public:
  StyledContext(const ContextStyle& style, const Grid& volume)
      : m_style(style),
        m_toMask(style.focus->grid.worldToIndex * volume.indexToWorld),
        m_field(style.focus->grid, style.focus->voxels),
        m_level(0.5 * style.focus->full) {}

  const ContextStyle& style() const { return m_style; }
  /// A point of the volume's index space. Beyond the mask its outermost voxels go on.
  bool isFocus(const Vec3& index) const { return m_field.value(m_toMask * index) >= m_level; }

private:
  const ContextStyle& m_style;
  Affine m_toMask;
  Field<std::uint8_t> m_field;
  double m_level;
};

} // namespace fenestra
