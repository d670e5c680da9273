#include "clip/surface/BufferFill.h"

#include "clip/portable/SmoothFill.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace fenestra::core {

void fillSmoothly(DepthBuffer& buffer, const std::vector<Region>& regions,
                  const std::vector<SilhouetteCells::HaloSample>& halo, double length) {
  FillGrid grid{buffer.xAxis().coordinates(), buffer.yAxis().coordinates(),
                buffer.depthsFromReference(), std::vector<std::uint8_t>(regions.size())};
  for (std::size_t sample = 0; sample < regions.size(); ++sample)
    grid.isKnown[sample] = regions[sample] == Region::focus ? 1 : 0;
  const auto setHalo = [&](double SilhouetteCells::HaloSample::*depth) {
    for (const SilhouetteCells::HaloSample& sample : halo) {
      const auto at = static_cast<std::size_t>(sample.sample);
      grid.isKnown[at] = 1;
      grid.depths[at] = static_cast<float>(sample.*depth - buffer.reference());
    }
  };
  // Which maxima are averaged can change from one camera to the next, so the far surface, which
  // averages by itself, is fitted to the maxima.
  setHalo(&SilhouetteCells::HaloSample::rayMaximum);
  const FarSurface far(grid, length);
  setHalo(&SilhouetteCells::HaloSample::depth);
  fillSmoothly(grid, far, length, [](std::size_t count, std::size_t grain, const auto& work) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [&](const auto& range) { work(range.begin(), range.end()); });
  });
  for (std::size_t sample = 0; sample < regions.size(); ++sample)
    if (regions[sample] != Region::focus)
      buffer.set(static_cast<std::int64_t>(sample),
                 buffer.reference() + double{grid.depths[sample]});
}

} // namespace fenestra::core
