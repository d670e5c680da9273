// The shader as a class. Included inside a namespace, after base/Formulas.h. The names that
// PathTracer.comp defines for the shader's files are members.

using Real = float;
#include "base/OneLane-inl.h"

template <int by>
Int shiftLeft(Int x) {
  return static_cast<Int>(static_cast<UInt>(x) << by);
}
template <int by>
Int shiftRight(Int x) {
  return x >> by;
}
inline Float toFloat(Int x) {
  return static_cast<Float>(x);
}
inline Float bitsAsFloat(auto x) {
  return std::bit_cast<Float>(x);
}
inline Int bitsAsInt(auto x) {
  return std::bit_cast<Int>(x);
}
inline UInt bitsAsUInt(auto x) {
  return std::bit_cast<UInt>(x);
}
inline bool isNaN(Float x) {
  return x != x;
}

using Point = Float3;
using Color = Float3;
using single::ClipTable;
using single::DepthTable;
CONSTANT Float largestReal = std::numeric_limits<Float>::max();
#define INOUT(T) T&

/// Hides functions of OneLane-inl.h that the C++ library computes.
namespace device {

inline Float floor(Float x) {
  return std::floor(x);
}

#include "formulas/Uniforms.inl"
// Uses no others:
#include "formulas/CellCubic.inl"
#include "formulas/Exponential.inl"
#include "formulas/Interpolation.inl"
#include "formulas/LightTables.inl"
// Use the ones above:
#include "formulas/Clip.inl"
#include "formulas/Environment.inl"
#include "formulas/Lights.inl"
#include "formulas/Scattering.inl"
// Use scattering:
#include "formulas/Paths.inl"
#include "formulas/Tracking.inl"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wsign-conversion" // GLSL indexes by int
#pragma push_macro("CONSTANT")
#undef CONSTANT
#define CONSTANT static constexpr

/// One thread of the shader.
class Shader : Features {
public:
  /// Non-owning: both arguments must outlive the object.
  Shader(const SceneTables& tables, const SimdMedium& medium)
      : Features(tables.features), scene(tables.numbers), m_words(tables.words), m_medium(medium) {}

  PathResult trace(const PathStart& start) {
    m_start = start;
    PathState state;
    startPath(state, 0);
    Walk walk = makeWalk(state.origin, state.ray);
    while (state.phase != idle)
      advance(state, walk);
    return m_result;
  }
  const std::array<std::uint64_t, workKinds>& counts() const { return m_counts; }

private:
  Float loadFloat(Int at) const { return bitsAsFloat(m_words[static_cast<std::size_t>(at)]); }
  Int loadInt(Int at) const { return bitsAsInt(m_words[static_cast<std::size_t>(at)]); }
  Int loadByte(Int at) const {
    return bitsAsInt(m_words[static_cast<std::size_t>(at >> 2)] >> (8 * (at & 3)) & 0xffU);
  }
  /// Index of a voxel; x fastest.
  static std::size_t placeOf(const SimdField& field, Int x, Int y, Int z) {
    const auto count = [&](std::size_t axis) {
      return static_cast<Int>(field.axes[axis].last) + 1;
    };
    return static_cast<std::size_t>((std::int64_t{z} * count(1) + y) * count(0) + x);
  }
  Float loadVoxel(Int x, Int y, Int z) const {
    const std::size_t place = placeOf(m_medium.field, x, y, z);
    return std::visit([&](const auto* voxels) { return static_cast<Float>(voxels[place]); },
                      m_medium.voxels);
  }
  Float loadFocus(Int x, Int y, Int z) const {
    const SimdField& focus = m_medium.context->focus;
    return static_cast<const std::uint8_t*>(focus.voxels)[placeOf(focus, x, y, z)];
  }
  const PathStart& loadStart(Int) const { return m_start; }
  void storeResult(Int, Int part, Float3 v, Float w) {
    float(&to)[3] = part == 0 ? m_result.radiance : part == 1 ? m_result.albedo : m_result.normal;
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
    (part == 0 ? m_result.scatterings : part == 1 ? m_result.depth : m_result.unused) = w;
  }
  void countWork(Int kind) { ++m_counts[static_cast<std::size_t>(kind)]; }

#include "integrator/gpu/shaders/Medium.inl"
  // Uses the medium:
#include "integrator/gpu/shaders/Silhouettes.inl"
  // Uses silhouettes:
#include "integrator/gpu/shaders/Clip.inl"
#include "integrator/gpu/shaders/Labels.inl"
#include "integrator/gpu/shaders/Maps.inl"
  // Use the ones above:
#include "integrator/gpu/shaders/Lights.inl"
#include "integrator/gpu/shaders/Path.inl"
  static_assert(sizeof(PathState) / 3 * 4 <= stateBytes); // GLSL may align a Float3 to 16 bytes

  const SceneNumbers& scene;
  const std::vector<std::uint32_t>& m_words;
  const SimdMedium& m_medium;
  PathStart m_start = {};
  PathResult m_result = {};
  std::array<std::uint64_t, workKinds> m_counts = {};
};

#pragma pop_macro("CONSTANT")
#pragma GCC diagnostic pop

} // namespace device

#undef INOUT
