#include "clipping/FocusDepth.h"

#include "clipping/FocusCells.h"
#include "clipping/Footprints.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace fenestra {

FocusDepth traceFocus(const Camera& camera, const Domain& volume, const Mask& focus) {
  FocusDepth result{DepthBuffer(camera, volume.grid()), {}};
  DepthBuffer& depth = result.depth;
  result.regions.assign(static_cast<std::size_t>(depth.size()), Region::outside);
  const FocusCells cells(focus);
  const FocusFootprint focusFootprint(camera, depth, cells);
  const DomainFootprint domainFootprint(camera, volume);

  const auto inVolume = [&](const Ray& ray) {
    return volume.clip(transformed(volume.grid().worldToIndex, ray));
  };
  const auto meetsVolume = [&](std::int64_t column, std::int64_t row) {
    return !inVolume(camera.rayThrough(depth.position(column, row))).empty();
  };
  const auto traceSample = [&](std::int64_t column, std::int64_t row) {
    const Interval depths = focusFootprint.depths(column, row);
    if (depths.empty())
      return Region::context;
    const Ray ray = camera.rayThrough(depth.position(column, row));
    const double depthPerLength = camera.depthPerLength(ray);
    Interval range = inVolume(ray);
    range.begin = std::max(range.begin, depths.begin / depthPerLength);
    range.end = std::min(range.end, depths.end / depthPerLength);
    const double t = cells.firstMeeting(ray, range);
    if (!(t < infinity))
      return Region::context;
    depth.set(depth.sample(column, row), t * depthPerLength);
    return Region::focus;
  };
  const auto traceRow = [&](std::int64_t row) {
    // The domain is convex: all between two samples that meet it do.
    auto [first, end] = domainFootprint.columns(depth, row);
    while (first < end && !meetsVolume(first, row))
      ++first;
    while (first < end && !meetsVolume(end - 1, row))
      --end;
    for (std::int64_t column = first; column < end; ++column)
      result.regions[static_cast<std::size_t>(depth.sample(column, row))] =
          traceSample(column, row);
  };
  tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, depth.rows()), [&](const auto& rows) {
    for (std::int64_t row = rows.begin(); row < rows.end(); ++row)
      traceRow(row);
  });
  return result;
}

} // namespace fenestra
