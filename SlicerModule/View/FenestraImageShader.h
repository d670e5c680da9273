#ifndef __FenestraImageShader_h
#define __FenestraImageShader_h

class vtkShaderProperty;

/// GLSL by which VTK's polygon mapper draws an image with depth over a complete view.
///
/// For the shader texts of VTK 9.1 to 9.6, and for a triangle whose corners are (-1, -1), (3, -1)
/// and (-1, 3) in the view's normalized device coordinates. Uniforms:
/// - `sampler2D fenestra_color`: straight alpha, the upper row first
/// - `sampler2D fenestra_depth`: mm along the view axis; above 1e30: nothing there
/// - `int fenestra_isResized`: the image and the view differ in size; colors are interpolated
/// - `int fenestra_fragments`: a value of `Fragments`
/// - `float fenestra_opacity`
/// - `vec2 fenestra_depthTerms` and `int fenestra_isParallel`: the depth in the window is x + y /
/// mm
///   in perspective, and x + y * mm in parallel projection
namespace FenestraImageShader {
constexpr float noDepth = 3e38F;

enum Fragments {
  Opaque,      ///< discards all others
  Translucent, ///< discards all others
  All
};

void AddReplacements(vtkShaderProperty* shader);
} // namespace FenestraImageShader

#endif
