#pragma once
// Many paths at once, for speed: all of a batch fly, then all scatter, then all look at their
// lights, and new paths replace those that have ended. A path depends on its own random numbers
// alone, so its sample is the same whichever paths share the batch.

#include "model/volume/Domain.h"
#include "transport/lanes/PathSteps.h"

#include <memory>
#include <optional>

namespace fenestra {

/// Start of a path: raster position, random numbers, and the ticket under which the sample is
/// delivered.
struct PathStart {
  double column, row;
  SampleNumbers numbers;
  std::uint64_t ticket;
};

class PathWave {
public:
  /// A view: all arguments must outlive the wave. The tracker must have the same `stop`: paths left
  /// unfinished are dropped here.
  PathWave(const Domain& domain, const WideTracker& tracker, const WideEvents& events,
           const EyeRays& eye, const StopFlag& stop)
      : m_domain(domain), m_tracker(tracker), m_events(events), m_eye(eye), m_stop(stop) {}

  /// Traces all paths of source.next(), at most `atOnce` together, and calls source.deliver(ticket,
  /// sample) for each, in any order. Returns false if `stop` became true before all had ended.
  template <typename Source>
  bool trace(Source& source, std::size_t atOnce, Counters& counters) const {
    const auto batch = std::make_unique<Batch>();
    const auto begin = [&](std::size_t place) {
      const std::optional<PathStart> from = source.next();
      if (from)
        this->begin(*batch, place, *from);
      counters.paths += from ? 1 : 0;
      return from.has_value();
    };
    std::size_t& size = batch->paths.rays.size;
    while (size < std::min(atOnce, RayBatch::capacity) && begin(size))
      ++size;
    while (size > 0) {
      m_tracker.sampleCollisions(batch->paths.rays, counters);
      if (stopped())
        return false;
      m_events.scatter(batch->paths, batch->lights, counters);
      look(*batch, counters);
      if (stopped())
        return false;
      // The last first: a path that moves into a gap has not ended.
      for (std::size_t i = batch->paths.endedCount; i-- > 0;) {
        const std::size_t place = batch->paths.ended[i];
        source.deliver(batch->origins[place].ticket, sample(*batch, place));
        if (!begin(place) && place != --size) {
          batch->paths.move(size, place);
          batch->origins[place] = batch->origins[size];
        }
      }
    }
    return true;
  }

private:
  bool stopped() const { return m_stop.load(std::memory_order_relaxed); }

  /// A path's eye ray.
  struct Origin {
    std::uint64_t ticket = 0;
    double row = 0.0;
    Ray ray;
    double begin = 0.0; ///< mm along `ray` to the beginning of the batch's ray
  };
  struct Batch {
    PathBatch paths;
    LightBatch lights;
    std::array<Origin, RayBatch::capacity> origins;
  };

  void begin(Batch& batch, std::size_t place, const PathStart& from) const {
    const Ray ray = m_eye.ray(from.column, from.row);
    const SampleNumbers& numbers = from.numbers;
    batch.paths.begin(place, ray.direction, uniform2Of(numbers.scattered), numbers.rest);
    const RayNumbers ofRay{static_cast<std::uint32_t>(numbers.depth >> 32),
                           narrow(uniformOf(numbers.acceptance))};
    const double begins =
        setInside(batch.paths.rays, place, m_domain, ray, m_eye.range(ray), ofRay);
    batch.origins[place] = {from.ticket, from.row, ray, begins};
  }

  void look(Batch& batch, Counters& counters) const {
    LightBatch& lights = batch.lights;
    m_tracker.estimateTransmittances(lights.rays, counters);
    for (std::size_t i = 0; i < lights.rays.size; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        batch.paths.radiance[c][lights.path[i]] += lights.radiance[c][i] * lights.rays.result[i];
  }

  PathSample sample(const Batch& batch, std::size_t place) const {
    const Origin& origin = batch.origins[place];
    const PathBatch& paths = batch.paths;
    if (paths.bounces[place] == 0) // escaped, or collided with a limit of 0 scatterings
      return std::isinf(paths.rays.result[place]) ? m_eye.escaped(origin.row, origin.ray)
                                                  : PathSample{};
    const auto triple = [&](const Columns3& columns) {
      return Rgb(columns[0][place], columns[1][place], columns[2][place]);
    };
    PathSample sample;
    sample.radiance = triple(paths.radiance);
    sample.albedo = triple(paths.firstAlbedo);
    sample.normal = triple(paths.firstNormal);
    const double distance = origin.begin + static_cast<double>(paths.firstDistance[place]);
    sample.depth = m_eye.depth(origin.ray, distance);
    sample.scatterings = static_cast<double>(paths.bounces[place]);
    return sample;
  }

  Domain m_domain;
  const WideTracker& m_tracker;
  const WideEvents& m_events;
  const EyeRays& m_eye;
  const StopFlag& m_stop;
};

} // namespace fenestra
