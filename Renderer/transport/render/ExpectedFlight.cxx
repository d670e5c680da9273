#include "transport/render/ExpectedFlight.h"

#include "transport/lanes/March.h"
#include "transport/readable/March.h"

#include <tbb/parallel_for.h>

#include <memory>

namespace fenestra {
namespace {

/// Expected values of one pixel.
struct Met {
  float hit = 0.0F, depth = 0.0F;
  std::array<float, 3> albedo = {}, normal = {}, facing = {};
};

/// A point of the picture through which a ray is marched.
struct RasterPoint {
  double column, row;
};

/// Rays of a picture, marched one by one.
template <typename Voxel>
class MarchedOneByOne {
public:
  MarchedOneByOne(const RenderScene& scene, const Medium<Voxel>& medium)
      : m_scene(scene),
        m_march({scene.volume.grid, scene.crop}, medium, scene.majorants, scene.clip) {}

  void along(std::span<const RasterPoint> points, Met* out) const {
    for (const RasterPoint& point : points) {
      const Ray ray = m_scene.camera.ray(point.column, point.row);
      const FirstMatter first = m_march.along(ray, visible(m_scene.clip, ray));
      Met met{narrow(first.hit), narrow(first.distance * m_scene.camera.depthPerLength(ray))};
      met.albedo = narrow3(first.albedo.matrix());
      met.normal = narrow3(first.normal);
      met.facing = narrow3(first.facing);
      *out++ = met;
    }
  }

private:
  const RenderScene& m_scene;
  March<Voxel> m_march;
};

/// The same in lanes.
class MarchedInLanes {
public:
  explicit MarchedInLanes(const RenderScene& scene)
      : m_scene(scene),
        m_domain(scene.volume.grid, scene.crop),
        m_tracker(scene.volume, m_domain, scene.transfer, scene.majorants, scene.clip, scene.style),
        m_events(scene.volume.grid, scene.transfer, scene.lights, 0, true) {}

  void along(std::span<const RasterPoint> points, Met* out) const {
    const auto batch = std::make_unique<MarchBatch>();
    const WideMarch march(m_tracker.scene(), m_events);
    std::array<double, RayBatch::capacity> before = {}, perLength = {};
    for (std::size_t from = 0; from < points.size(); from += RayBatch::capacity) {
      const std::size_t count = std::min(points.size() - from, RayBatch::capacity);
      batch->rays.size = count;
      for (std::size_t i = 0; i < count; ++i) {
        const Ray ray = m_scene.camera.ray(points[from + i].column, points[from + i].row);
        before[i] = setInside(batch->rays, i, m_domain, ray, visible(m_scene.clip, ray), 0);
        perLength[i] = m_scene.camera.depthPerLength(ray);
      }
      march.along(*batch);
      for (std::size_t i = 0; i < count; ++i)
        *out++ = metIn(*batch, i, before[i], perLength[i]);
    }
  }

private:
  static Met metIn(const MarchBatch& batch, std::size_t i, double before, double perLength) {
    Met met;
    met.hit = batch.hit[i];
    met.depth = narrow((batch.distance[i] + before * batch.hit[i]) * perLength);
    for (std::size_t c = 0; c < 3; ++c) {
      met.albedo[c] = batch.albedo[c][i];
      met.normal[c] = batch.normal[c][i];
      met.facing[c] = batch.facing[c][i];
    }
    return met;
  }

  const RenderScene& m_scene;
  Domain m_domain;
  WideTracker m_tracker;
  EventScene m_events;
};

/// Pixels, row 0 at the top.
struct Raster {
  int width, height;
  std::vector<Met> pixels;

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
  }
};

/// True if two neighbouring rays see different things. `pitch`: mm between pixels.
bool differ(const Met& a, const Met& b, double pitch) {
  constexpr float colors = 0.08F, slope = 4.0F;
  const auto apart = [&](std::size_t c) { return std::abs(a.albedo[c] - b.albedo[c]) > colors; };
  if (apart(0) || apart(1) || apart(2) || std::abs(a.hit - b.hit) > colors)
    return true;
  const float both = std::min(a.hit, b.hit);
  return both > 0.0F &&
         std::abs(a.depth / a.hit - b.depth / b.hit) * both > slope * static_cast<float>(pitch);
}

bool isAtEdge(const Raster& raster, int column, int row, double pitch) {
  const Met& here = raster.pixels[raster.index(column, row)];
  const auto differsFrom = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < raster.width && y < raster.height &&
           differ(here, raster.pixels[raster.index(x, y)], pitch);
  };
  return differsFrom(column - 1, row) || differsFrom(column + 1, row) ||
         differsFrom(column, row - 1) || differsFrom(column, row + 1);
}

Met meanOf(std::span<const Met> parts) {
  Met mean;
  const float share = 1.0F / static_cast<float>(parts.size());
  for (const Met& part : parts) {
    mean.hit += share * part.hit;
    mean.depth += share * part.depth;
    for (std::size_t c = 0; c < 3; ++c) {
      mean.albedo[c] += share * part.albedo[c];
      mean.normal[c] += share * part.normal[c];
      mean.facing[c] += share * part.facing[c];
    }
  }
  return mean;
}

template <typename March>
Raster marched(const Camera& camera, const March& march) {
  const int width = camera.width(), height = camera.height();
  Raster raster{width, height, {}};
  raster.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  tbb::parallel_for(0, height, [&](int row) {
    std::vector<RasterPoint> middles;
    for (int column = 0; column < width; ++column)
      middles.push_back({column + 0.5, row + 0.5});
    march.along(middles, &raster.pixels[raster.index(0, row)]);
  });
  std::vector<std::vector<int>> edges(static_cast<std::size_t>(height)); // columns
  tbb::parallel_for(0, height, [&](int row) {
    for (int column = 0; column < width; ++column)
      if (isAtEdge(raster, column, row, camera.pixelPitch()))
        edges[static_cast<std::size_t>(row)].push_back(column);
  });
  tbb::parallel_for(0, height, [&](int row) {
    std::vector<RasterPoint> points;
    for (const int column : edges[static_cast<std::size_t>(row)])
      for (const double y : {0.25, 0.75})
        for (const double x : {0.25, 0.75})
          points.push_back({column + x, row + y});
    std::vector<Met> parts(points.size());
    march.along(points, parts.data());
    std::span<const Met> left = parts;
    for (const int column : edges[static_cast<std::size_t>(row)]) {
      raster.pixels[raster.index(column, row)] = meanOf(left.first(4));
      left = left.subspan(4);
    }
  });
  return raster;
}

ExpectedFlight flightOf(const Raster& raster) {
  ExpectedFlight flight;
  const auto plane = [&](Plane& values, auto&& valueOf) {
    values.reserve(raster.pixels.size());
    for (const Met& met : raster.pixels)
      values.push_back(valueOf(met));
  };
  plane(flight.hit, [](const Met& met) { return met.hit; });
  plane(flight.depth, [](const Met& met) { return met.depth; });
  for (std::size_t c = 0; c < 3; ++c) {
    plane(flight.albedo[c], [c](const Met& met) { return met.albedo[c]; });
    plane(flight.normal[c], [c](const Met& met) { return met.normal[c]; });
    plane(flight.facing[c], [c](const Met& met) { return met.facing[c]; });
  }
  return flight;
}

} // namespace

ExpectedFlight expectedFlight(const RenderScene& scene) {
  if (lanesServe(scene))
    return flightOf(marched(scene.camera, MarchedInLanes(scene)));
  return expectedFlightOneByOne(scene);
}

ExpectedFlight expectedFlightOneByOne(const RenderScene& scene) {
  return withMedium(scene, [&]<typename Voxel>(const Medium<Voxel>& medium, const Tracker<Voxel>&) {
    return flightOf(marched(scene.camera, MarchedOneByOne<Voxel>(scene, medium)));
  });
}

} // namespace fenestra
