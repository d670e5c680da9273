#pragma once

#include "fenestra/Error.h"

#include <map>
#include <memory>
#include <span>
#include <vector>

namespace fenestra {
inline namespace v1 {

enum class Tone { film, photographic };

/// How radiance becomes display values.
struct Display {
  Tone tone = Tone::film;
  double exposure = 0.0;       ///< stops: radiance is multiplied by 2^exposure
  bool hasScale = false;       ///< a scale bar; orthographic projection only
  bool hasOrientation = false; ///< letters for the patient's sides
};

/// Result of a render. Immutable; copies share the pixels. Arrays have one value per pixel, row by
/// row from the top, and live as long as a copy of the image.
class FENESTRA_EXPORT Image {
public:
  int width() const;
  int height() const;

  /// Radiance, linear Rec. 709 with premultiplied alpha, 4 values per pixel. Unbiased.
  std::span<const float> rgba() const;
  /// Denoised, as rgba(); empty: the image was not denoised.
  std::span<const float> denoised() const;
  /// Mean depth of the first collision along the viewing direction, mm; infinity: none.
  std::span<const float> depth() const;
  /// Depth of the clipping surface, mm; empty without a clip.
  std::span<const float> clipDepth() const;
  /// At the first collision, mean over samples, world axes: 3 values per pixel.
  std::span<const float> normals() const;
  std::span<const float> albedo() const; ///< likewise
  /// Standard error of rgba(), 3 values per pixel.
  std::span<const float> error() const;
  std::span<const float> sampleCounts() const;

  /// Noise of the image: root of the mean of error^2 / (radiance^2 + 0.01).
  double noise() const;
  /// Estimated noise after denoising; infinity: unknown.
  double denoisedNoise() const;
  /// Mean samples per pixel.
  std::uint64_t samples() const;
  /// False if the render was stopped before it reached its limits.
  bool isComplete() const;
  /// Version, seed, samples, camera and what else reproduces the image.
  const std::map<std::string, std::string>& metadata() const;

  /// 8-bit RGBA, sRGB with straight alpha, of the denoised image if there is one.
  std::vector<std::uint8_t> display(const Display& display = {}) const;
  /// The same as the bytes of a .png file.
  std::string png(const Display& display = {}) const;
  /// Writes a .png, .tif (for display), .exr or .nrrd (raw). An existing file is replaced when the
  /// new one is complete. Throws Error (request, output).
  void save(const std::string& path, const Display& display = {}) const;

  struct Data;
  explicit Image(std::shared_ptr<const Data> data);

private:
  std::shared_ptr<const Data> m_data;
};

} // namespace v1
} // namespace fenestra
