#include "session/Measures.h"

#include "measure/FocusMeasures.h"

namespace fenestra {

std::optional<FocusReport> measureFocus(const Scene& scene, std::uint64_t seed,
                                        const StopFlag& stop) {
  if (!scene.focus() || scene.focusDepth().empty())
    return std::nullopt;
  const RenderScene clipped = scene.forRender();
  const Clip noClip = ClipNone();
  const auto majorantsFor = [&](const ContextStyle* style) {
    return MajorantGrid(scene.volume().grid, scene.ranges(), scene.transfer(), noClip, style);
  };
  const auto unclipped = [&](const MajorantGrid& majorants, const ContextStyle* style) {
    return RenderScene{clipped.volume, clipped.transfer, majorants,    clipped.lights,
                       clipped.camera, noClip,           clipped.crop, style};
  };
  const std::shared_ptr<const Mask> mask(std::shared_ptr<void>(), scene.focus());
  const ContextStyle nothingElse{mask, 0.0, 1.0};
  const MajorantGrid whole = majorantsFor(scene.style()), alone = majorantsFor(&nothingElse);
  const RenderScene wholeScene = unclipped(whole, scene.style());

  const FocusPoints points(clipped, scene.focusDepth());
  FocusReport report;
  report.kept = points.kept();
  report.coverage = focusCoverage(clipped, points, seed, stop);
  if (stop)
    return std::nullopt;
  report.withoutClip =
      focusCoverage(wholeScene, FocusPoints(wholeScene, scene.focusDepth()), seed, stop);
  if (stop)
    return std::nullopt;
  report.light = focusLight(clipped, unclipped(alone, &nothingElse), points, seed, stop);
  if (stop)
    return std::nullopt;
  report.contextRemoved = contextRemoved(clipped, *mask, seed);
  return report;
}

} // namespace fenestra
