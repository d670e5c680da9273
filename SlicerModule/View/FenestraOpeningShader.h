#ifndef __FenestraOpeningShader_h
#define __FenestraOpeningShader_h

#include <string>

/// GLSL that starts the rays of VTK's GPU volume ray caster on a clipping surface.
///
/// For the shader texts of VTK 9.1 to 9.6. Uniforms:
/// - `sampler2D fenestra_focus`, `fenestra_fill`: axial depths, mm, the upper row first. In the
///   focus, `notFocus`: no focus.
/// - `vec4 fenestra_focusWindow`, `fenestra_fillWindow`: outer corner of the first sample on the
///   plane through the target, mm, and 1 / extent per axis, 1/mm; y is negative
/// - `float fenestra_targetDepth`: mm; 0: orthographic
/// - `int fenestra_mode`: a value of `Modes`
/// - `float fenestra_offset`: moves the surface away from the camera, mm
namespace FenestraOpening {
constexpr float notFocus = 3e38F;

enum Modes {
  Off,     ///< VTK's own rays
  Surface, ///< rays start at the focus, and beside it at the fill
  Cutaway  ///< rays start at the focus; others are VTK's own
};

/// Inserts the start of the rays, before VTK replaces its tags. False if tags are missing.
bool InsertBeforeReplacement(std::string& fragment);

/// Inserts the shading of the cut by the surface's normal, after VTK replaced its tags: gradients
/// of the volume are noise there. Texts without the expected lines are left as they are.
void InsertAfterReplacement(std::string& fragment);
} // namespace FenestraOpening

#endif
