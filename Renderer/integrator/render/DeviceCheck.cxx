#include "integrator/render/DeviceCheck.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fenestra::core {
namespace {

/// One sample for each pixel of a coarse grid over the image: a source of paths.
class ProbeSource {
public:
  ProbeSource(int width, int height, const Sampler& sampler)
      : m_width(width), m_height(height), m_sampler(sampler), m_results(edge * edge) {}

  void fill(CameraSamples& samples, std::size_t maxCount) {
    samples.size = std::min(maxCount, m_results.size() - m_next);
    samples.isStratified = m_sampler.isStratified();
    for (std::size_t i = 0; i < samples.size; ++i, ++m_next) {
      const int column = place(m_next % edge, m_width), row = place(m_next / edge, m_height);
      const std::int64_t pixel = std::int64_t{row} * m_width + column;
      const Sampler::Stream stream = m_sampler.stream(static_cast<std::uint64_t>(pixel), 0);
      samples.column[i] = static_cast<float>(column);
      samples.row[i] = static_cast<float>(row);
      samples.start[i] = stream.start;
      samples.key[i] = stream.key;
      samples.number[i] = 0;
      samples.tileSample[i] = static_cast<std::uint32_t>(m_next);
    }
  }
  void deliver(std::uint32_t, std::uint32_t place, const PathSample& sample) {
    m_results[place] = sample;
  }
  const std::vector<PathSample>& results() const { return m_results; }

private:
  static constexpr std::size_t edge = 16; ///< probes per row and column

  static int place(std::size_t i, int count) {
    return static_cast<int>((2 * i + 1) * static_cast<std::size_t>(count) / (2 * edge));
  }

  int m_width, m_height;
  Sampler m_sampler;
  std::vector<PathSample> m_results;
  std::size_t m_next = 0;
};

/// True if two results of a path are equal, except for rounding.
bool areAlike(const PathSample& a, const PathSample& b) {
  const auto isNear = [](double x, double y) {
    return x == y || (std::isnan(x) && std::isnan(y)) ||
           std::abs(x - y) <= 1e-2 * std::max(std::abs(x), std::abs(y));
  };
  return isNear(a.radiance.sum(), b.radiance.sum()) && isNear(a.depth, b.depth) &&
         isNear(a.albedo.sum(), b.albedo.sum()) && a.alpha == b.alpha;
}

} // namespace

void checkDevice(const gpu::DeviceIntegrator& device, const SimdPathIntegrator& simd,
                 const Camera& camera, const Sampler& sampler) {
  ProbeSource onDevice(camera.width(), camera.height(), sampler), onCpu = onDevice;
  Counters ignored;
  const auto most = std::numeric_limits<std::size_t>::max();
  if (!device.trace(0, onDevice, most, ignored) || !simd.trace(onCpu, most, ignored))
    return;
  std::size_t colliding = 0, alike = 0;
  for (std::size_t i = 0; i < onCpu.results().size(); ++i) {
    const PathSample &a = onDevice.results()[i], &b = onCpu.results()[i];
    if (a.scatterings == 0.0 && b.scatterings == 0.0)
      continue;
    ++colliding;
    alike += areAlike(a, b) ? 1U : 0U;
  }
  if (2 * alike < colliding)
    throw gpu::DeviceError("its results differ from those of the CPU");
}

} // namespace fenestra::core
