#pragma once

#include "fenestra/Image.h"
#include "fenestra/Scene.h"

#include <functional>

namespace fenestra {
inline namespace v1 {

enum class Quality { draft, normal, high, final };

/// Behind the volume.
struct Background {
  enum class Kind { dark, gray, color, gradient, transparent, environment };
  Kind kind = Kind::dark;
  Color color = {}; ///< of `color`
};

/// A render stops at the first of the limits.
/// What renders. On `gpu` the CPU steps in where no GPU, or not the scene, allows it: the image's
/// metadata state the "target" that rendered it.
enum class Device { cpu, gpu };

struct RenderOptions {
  int width = 512, height = 512;
  /// Limit of the mean number per pixel; by default 64 if there is no other limit, else none.
  std::optional<std::uint64_t> samples = {};
  std::optional<double> seconds = {}; ///< limit of the time
  std::optional<double> noise = {};   ///< limit of the noise, of the denoised image if there is one
  bool isDenoised = true;             ///< adds Image::denoised()
  std::optional<std::uint64_t> bounces = {}; ///< limit of scatterings per path; unlimited
  std::uint64_t seed = 0;
  int threads = 0; ///< 0: all
  Device device = Device::cpu;
  std::optional<Background> background = {}; ///< of a Slicer scene, else dark
};

/// Options with the limits that a level of quality stands for.
FENESTRA_EXPORT RenderOptions makeRenderOptions(Quality quality);

struct Progress {
  double fraction = 0.0; ///< 0 to 1, estimated; 0 while the scene is prepared
  double seconds = 0.0;  ///< since the start
  double noise = 0.0;    ///< latest estimate; infinity: none yet
};

/// Called by the thread that called render(), several times per second. False stops the render.
using ProgressCallback = std::function<bool(const Progress&)>;

/// Renders a scene. Stopped by the callback, it returns the image of the samples so far (see
/// Image::isComplete), or throws Error (request, "stopped") if there are none. An exception from
/// the callback stops the render and is passed on. The same options give the same image, bit for
/// bit, whatever the number of threads. Throws Error: request, input, or output if memory runs out.
FENESTRA_EXPORT Image render(const Scene& scene, const RenderOptions& options = {},
                             const ProgressCallback& onProgress = {});

} // namespace v1
} // namespace fenestra
