#include "FenestraImageShader.h"

#include <vtkShaderProperty.h>

namespace {

constexpr char imageVertexDeclarations[] = R"GLSL(
out vec2 fenestra_at;
//VTK::PositionVC::Dec)GLSL";

// After VTK's own projection.
constexpr char imagePosition[] = R"GLSL(
//VTK::PositionVC::Impl
  gl_Position = vec4(vertexMC.xy, 0.0, 1.0);
  fenestra_at = vec2(0.5 + 0.5 * vertexMC.x, 0.5 - 0.5 * vertexMC.y);
)GLSL";

constexpr char imageDeclarations[] = R"GLSL(
in vec2 fenestra_at; // in the view, 0 to 1 from the upper left corner
uniform sampler2D fenestra_color;
uniform sampler2D fenestra_depth;
uniform int fenestra_isResized;
uniform int fenestra_fragments;
uniform float fenestra_opacity;
uniform vec2 fenestra_depthTerms;
uniform int fenestra_isParallel;

const float fenestra_noDepth = 3e38;
// Largest number below 1, the depth of the background.
const float fenestra_farthest = 0.99999994;

// Of four neighboring pixels: weighted sum of colors, and the depth of the nearest that has one.
struct fenestra_Sum
{
  vec4 color; // premultiplied
  float depth;
  float weight; // of the pixel whose depth it is
};

void fenestra_add(inout fenestra_Sum sum, ivec2 pixel, float weight)
{
  pixel = clamp(pixel, ivec2(0), textureSize(fenestra_color, 0) - 1);
  vec4 color = texelFetch(fenestra_color, pixel, 0);
  sum.color += weight * vec4(color.rgb * color.a, color.a);
  float depth = texelFetch(fenestra_depth, pixel, 0).r;
  if (depth < 1e30 && weight > sum.weight)
  {
    sum.depth = depth;
    sum.weight = weight;
  }
}

// Straight alpha.
vec4 fenestra_sample(out float depth)
{
  vec2 size = vec2(textureSize(fenestra_color, 0));
  vec2 at = fenestra_at * size;
  if (fenestra_isResized == 0)
  {
    ivec2 pixel = clamp(ivec2(floor(at)), ivec2(0), ivec2(size) - 1);
    depth = texelFetch(fenestra_depth, pixel, 0).r;
    return texelFetch(fenestra_color, pixel, 0);
  }
  at -= 0.5;
  ivec2 first = ivec2(floor(at));
  vec2 part = at - vec2(first);
  fenestra_Sum sum = fenestra_Sum(vec4(0.0), fenestra_noDepth, 0.0);
  fenestra_add(sum, first, (1.0 - part.x) * (1.0 - part.y));
  fenestra_add(sum, first + ivec2(1, 0), part.x * (1.0 - part.y));
  fenestra_add(sum, first + ivec2(0, 1), (1.0 - part.x) * part.y);
  fenestra_add(sum, first + ivec2(1, 1), part.x * part.y);
  depth = sum.depth;
  return vec4(sum.color.rgb / max(sum.color.a, 1e-6), sum.color.a);
}

float fenestra_toWindow(float depth)
{
  float mm = fenestra_isParallel != 0 ? depth : 1.0 / depth;
  return clamp(fenestra_depthTerms.x + fenestra_depthTerms.y * mm, 0.0, fenestra_farthest);
}

//VTK::Light::Dec)GLSL";

// Without VTK's tag, so that no other depth is written. Before depth peeling looks at the depth.
constexpr char imageDepth[] = R"GLSL(
  float fenestra_mm;
  vec4 fenestra_rgba = fenestra_sample(fenestra_mm);
  bool fenestra_isOpaque = fenestra_rgba.a > 1.0 - 0.5 / 255.0 && fenestra_opacity >= 1.0;
  if (fenestra_rgba.a <= 0.0 || (fenestra_fragments == 0 && !fenestra_isOpaque) ||
      (fenestra_fragments == 1 && fenestra_isOpaque))
  {
    discard;
  }
  fenestra_rgba.a = fenestra_isOpaque ? 1.0 : fenestra_rgba.a * fenestra_opacity;
  gl_FragDepth = fenestra_toWindow(fenestra_mm);
)GLSL";

// Without VTK's tag: the image is lit.
constexpr char imageColor[] = R"GLSL(
  gl_FragData[0] = fenestra_rgba;
)GLSL";

} // namespace

void FenestraImageShader::AddReplacements(vtkShaderProperty* shader) {
  shader->AddVertexShaderReplacement("//VTK::PositionVC::Dec", true, imageVertexDeclarations,
                                     false);
  shader->AddVertexShaderReplacement("//VTK::PositionVC::Impl", true, imagePosition, false);
  shader->AddFragmentShaderReplacement("//VTK::Light::Dec", true, imageDeclarations, false);
  shader->AddFragmentShaderReplacement("//VTK::Depth::Impl", true, imageDepth, false);
  shader->AddFragmentShaderReplacement("//VTK::Light::Impl", true, imageColor, false);
}
