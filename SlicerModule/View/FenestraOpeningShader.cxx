#include "FenestraOpeningShader.h"

namespace {

constexpr char declarations[] = R"GLSL(
uniform sampler2D fenestra_focus;
uniform sampler2D fenestra_fill;
uniform vec4 fenestra_focusWindow;
uniform vec4 fenestra_fillWindow;
uniform float fenestra_targetDepth;
uniform int fenestra_mode;
uniform float fenestra_offset;

const float fenestra_unknownSlope = 1e9;

// Of this ray:
bool fenestra_isCut = false;
vec3 fenestra_cutNormal = vec3(0.0); // view space, toward the camera; 0: unknown
float fenestra_mmPerStep = 1.0;

// Above 1e30: no focus.
float fenestra_findFocus(vec2 at)
{
  bool isInside = all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(1.0)));
  return isInside ? textureLod(fenestra_focus, at, 0.0).r : 3e38;
}

// Slope from two neighbors at a distance in mm, without neighbors beyond a depth discontinuity.
float fenestra_findSlope(float before, float depth, float after, float distance)
{
  float limit = 8.0 * distance;
  bool hasBefore = abs(before - depth) < limit;
  bool hasAfter = abs(after - depth) < limit;
  if (hasBefore && hasAfter)
  {
    return (after - before) / (2.0 * distance);
  }
  if (hasAfter)
  {
    return (after - depth) / distance;
  }
  return hasBefore ? (depth - before) / distance : fenestra_unknownSlope;
}

vec2 fenestra_findFocusSlope(vec2 at, float depth)
{
  vec2 h = 2.0 / vec2(textureSize(fenestra_focus, 0));
  vec2 mm = abs(h / fenestra_focusWindow.zw);
  return vec2(fenestra_findSlope(fenestra_findFocus(at - vec2(h.x, 0.0)), depth,
                                 fenestra_findFocus(at + vec2(h.x, 0.0)), mm.x),
              fenestra_findSlope(fenestra_findFocus(at + vec2(0.0, h.y)), depth,
                                 fenestra_findFocus(at - vec2(0.0, h.y)), mm.y));
}

float fenestra_findFill(vec2 at)
{
  return textureLod(fenestra_fill, at, 0.0).r;
}

vec2 fenestra_findFillSlope(vec2 at)
{
  vec2 h = 1.0 / vec2(textureSize(fenestra_fill, 0));
  return vec2(fenestra_findFill(at + vec2(h.x, 0.0)) - fenestra_findFill(at - vec2(h.x, 0.0)),
              fenestra_findFill(at + vec2(0.0, h.y)) - fenestra_findFill(at - vec2(0.0, h.y))) *
         fenestra_fillWindow.zw / (2.0 * h);
}

// Axial depth at a position on the plane through the target, mm. False: no surface there.
bool fenestra_findDepth(vec2 position, out float depth, out vec2 slope)
{
  vec2 at = (position - fenestra_focusWindow.xy) * fenestra_focusWindow.zw;
  depth = fenestra_findFocus(at);
  slope = vec2(fenestra_unknownSlope);
  if (depth < 1e30)
  {
    slope = fenestra_findFocusSlope(at, depth);
    return true;
  }
  if (fenestra_mode != 1)
  {
    return false;
  }
  at = (position - fenestra_fillWindow.xy) * fenestra_fillWindow.zw;
  depth = fenestra_findFill(at);
  slope = fenestra_findFillSlope(at);
  return true;
}

vec3 fenestra_findNormal(vec2 position, float depth, vec2 slope)
{
  if (max(slope.x, slope.y) >= fenestra_unknownSlope)
  {
    return vec3(0.0);
  }
  if (fenestra_targetDepth <= 0.0)
  {
    return normalize(vec3(slope, 1.0));
  }
  vec3 alongX = vec3(vec2(depth, 0.0) + position * slope.x, -slope.x * fenestra_targetDepth);
  vec3 alongY = vec3(vec2(0.0, depth) + position * slope.y, -slope.y * fenestra_targetDepth);
  return normalize(cross(alongX, alongY));
}

// Moves the start of the ray to the surface, never toward the camera. NaNs leave the ray as it is.
void fenestra_openRay()
{
  if (fenestra_mode == 0)
  {
    return;
  }
  vec4 entry = in_modelViewMatrix * (in_volumeMatrix[0] * vec4(ip_vertexPos, 1.0));
  bool isPerspective = fenestra_targetDepth > 0.0;
  vec2 position = isPerspective ? entry.xy * (fenestra_targetDepth / -entry.z) : entry.xy;
  float depth;
  vec2 slope;
  if (!fenestra_findDepth(position, depth, slope))
  {
    return;
  }
  depth += fenestra_offset;
  vec2 xy = isPerspective ? position * (depth / fenestra_targetDepth) : position;
  vec4 cut = ip_inverseTextureDataAdjusted *
             (in_inverseVolumeMatrix[0] * (in_inverseModelViewMatrix * vec4(xy, -depth, 1.0)));
  // The ray's start is jittered, so the cut is, too.
  float steps = dot(cut.xyz / cut.w + g_rayJitter - g_rayOrigin, g_dirStep) /
                dot(g_dirStep, g_dirStep);
  if (!(steps > 0.0))
  {
    return;
  }
  g_rayOrigin += steps * g_dirStep;
  g_dataPos = g_rayOrigin;
  g_terminatePointMax -= steps;
  if (!(g_terminatePointMax > 0.0) ||
      any(greaterThan(max(g_dirStep, vec3(0.0)) * (g_rayOrigin - in_texMax[0]), vec3(0.0))) ||
      any(greaterThan(min(g_dirStep, vec3(0.0)) * (g_rayOrigin - in_texMin[0]), vec3(0.0))))
  {
    discard;
  }
  fenestra_isCut = true;
  fenestra_cutNormal = fenestra_findNormal(position, depth, slope);
  fenestra_mmPerStep = length((in_modelViewMatrix * (in_volumeMatrix[0] *
    (in_textureDatasetMatrix[0] * vec4(g_dirStep, 0.0)))).xyz);
}

// Replaces the normal by the surface's over some mm behind the cut.
vec3 fenestra_shade(vec3 normal, vec3 cutNormal)
{
  const float thickness = 2.0; // mm
  if (!fenestra_isCut || fenestra_cutNormal == vec3(0.0))
  {
    return normal;
  }
  float mm = length(g_dataPos - g_rayOrigin) / length(g_dirStep) * fenestra_mmPerStep;
  float weight = clamp(1.5 - mm / thickness, 0.0, 1.0);
  if (weight == 0.0)
  {
    return normal;
  }
  vec3 facing = dot(normal, cutNormal) < 0.0 ? -normal : normal;
  return normalize(mix(facing, cutNormal, weight) + 1e-6 * cutNormal);
}

// Normals of planes transform by the transpose of the inverse.
vec3 fenestra_toData(vec3 normal)
{
  return normalize(normal * mat3(in_modelViewMatrix * in_volumeMatrix[0]));
}

//VTK::ComputeLighting::Dec)GLSL";

// After VTK's own clipping planes.
constexpr char start[] = R"GLSL(
//VTK::Clipping::Init
  fenestra_openRay();
)GLSL";

struct Replacement {
  const char *found, *replacement;
};

constexpr Replacement shading[] = {
    // VTK 9.1, headlight: normals point outward.
    {"float nDotL = dot(normal, g_ldir[0]);",
     "normal = fenestra_shade(normal, fenestra_toData(fenestra_cutNormal));\n"
     "float nDotL = dot(normal, g_ldir[0]);"},
    // VTK 9.1, other lights.
    {"for (int lightNum = 0; lightNum < in_numberOfLights; lightNum++)",
     "normal = fenestra_shade(normal, fenestra_cutNormal);\n"
     "for (int lightNum = 0; lightNum < in_numberOfLights; lightNum++)"},
    // VTK 9.2 to 9.6, headlight: normals point inward.
    {"float nDotL = dot(normal, -g_ldir[0]);",
     "normal = -fenestra_shade(-normal, fenestra_toData(fenestra_cutNormal));\n"
     "float nDotL = dot(normal, -g_ldir[0]);"},
    // VTK 9.2 to 9.6, other lights.
    {"vec3 normal = normalize((in_textureToEye[0] * vec4(shading_gradient.xyz, 0.0)).xyz);",
     "vec3 normal = -fenestra_shade(\n"
     "  -normalize((in_textureToEye[0] * vec4(shading_gradient.xyz, 0.0)).xyz),\n"
     "  fenestra_cutNormal);"}};

/// False if the text is not found.
bool ReplaceAll(std::string& text, const Replacement& pair) {
  const std::string found = pair.found, replacement = pair.replacement;
  bool isFound = false;
  for (std::size_t at = text.find(found); at != std::string::npos;
       at = text.find(found, at + replacement.size())) {
    text.replace(at, found.size(), replacement);
    isFound = true;
  }
  return isFound;
}

} // namespace

bool FenestraOpening::InsertBeforeReplacement(std::string& fragment) {
  return ReplaceAll(fragment, {"//VTK::ComputeLighting::Dec", declarations}) &&
         ReplaceAll(fragment, {"//VTK::Clipping::Init", start});
}

void FenestraOpening::InsertAfterReplacement(std::string& fragment) {
  for (const Replacement& pair : shading)
    ReplaceAll(fragment, pair);
}
