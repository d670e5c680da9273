#include "transport/render/ExpectedFlight.h"

#include <tbb/parallel_for.h>

namespace fenestra {
namespace {

/// Expected values of one ray or one pixel.
struct Met {
  double hit = 0.0, depth = 0.0;
  Rgb albedo = Rgb::Zero();
  Vec3 normal = Vec3::Zero();

  void add(const Met& other, double share) {
    hit += share * other.hit;
    depth += share * other.depth;
    albedo += share * other.albedo;
    normal += share * other.normal;
  }
};

/// Marches along eye rays.
template <typename Voxel>
class March {
public:
  March(const RenderScene& scene, const Medium<Voxel>& medium)
      : m_scene(scene), m_medium(medium), m_domain(scene.volume.grid, scene.crop) {
    const ClipEdge edge = std::visit([](const auto& clip) { return clip.edge; }, scene.clip);
    m_keepIsOne = edge.isHard() && edge.softness == 0.0;
  }

  Met along(double column, double row) const {
    const Ray eye = m_scene.camera.ray(column, row);
    const Affine& worldToIndex = m_scene.volume.grid.worldToIndex;
    const Interval inside =
        m_domain.clip(transformed(worldToIndex, eye), visible(m_scene.clip, eye));
    if (inside.empty())
      return {};
    const Ray ray{eye.at(inside.begin), eye.direction}; // keeps the digits of lengths
    Walk walk{.ray = ray,
              .indexRay = transformed(worldToIndex, ray),
              .depthPerLength = m_scene.camera.depthPerLength(eye),
              .depthAtStart = inside.begin * m_scene.camera.depthPerLength(eye)};
    walk.shortest = 0.5 / walk.indexRay.direction.norm();
    GridWalk cells(transformed(m_scene.majorants.worldToCell(), ray),
                   {0.0, inside.end - inside.begin}, m_scene.majorants.cellCount());
    for (; !cells.done() && walk.transmittance > dark; cells.next())
      cross(m_scene.majorants.cell(cells.cell()), cells.interval(), walk);
    // The rest of the light ends where the last of it did.
    if (walk.transmittance <= dark)
      walk.pending += walk.transmittance;
    if (walk.pending > 0.0)
      collect(walk);
    return walk.met;
  }

private:
  static constexpr double dark = 1e-3;      ///< transmittance at which a ray ends
  static constexpr double thin = 0.05;      ///< optical depth that a step may always have
  static constexpr double share = 1.0 / 64; ///< of the light, for which matter is looked up
  static constexpr int mostSteps = 64;      ///< in a cell

  struct Walk {
    Ray ray, indexRay;                                   ///< from the entry into the domain
    double depthPerLength, depthAtStart, shortest = 0.0; ///< shortest step, mm: half a voxel
    double transmittance = 1.0;
    double pending = 0.0; ///< share of collisions since the last one that was collected
    double last = 0.0;    ///< mm to the last of these
    Met met = {};
  };

  void cross(const MajorantGrid::Cell& cell, const Interval& interval, Walk& walk) const {
    if (cell.majorant == 0.0F)
      return;
    const double length = interval.end - interval.begin;
    const double step = std::max(walk.shortest, thin / static_cast<double>(cell.majorant));
    const int steps = static_cast<int>(std::clamp(std::ceil(length / step), 1.0, 1.0 * mostSteps));
    const double each = length / steps;
    for (int i = 0; i < steps && walk.transmittance > dark; ++i) {
      const double t = interval.begin + (i + 0.5) * each;
      const double kept = cell.cut && !m_keepIsOne ? keep(m_scene.clip, walk.ray.at(t)) : 1.0;
      const double extinction = kept > 0.0 ? kept * m_medium.extinction(walk.indexRay.at(t)) : 0.0;
      if (!(extinction > 0.0))
        continue;
      const double stopped = walk.transmittance * -std::expm1(-extinction * each);
      walk.transmittance -= stopped;
      walk.pending += stopped;
      walk.last = t;
      if (walk.pending > share)
        collect(walk);
    }
  }

  /// Adds the pending collisions with the matter at the last of them.
  void collect(Walk& walk) const {
    const Matter matter = m_medium.matter(walk.indexRay.at(walk.last), true);
    const double slope = matter.gradient.norm();
    Met here{1.0, walk.depthAtStart + walk.last * walk.depthPerLength, matter.albedo};
    if (slope > 0.0 && std::isfinite(slope))
      here.normal =
          matter.gradient / (walk.ray.direction.dot(matter.gradient) < 0.0 ? slope : -slope);
    walk.met.add(here, walk.pending);
    walk.pending = 0.0;
  }

  const RenderScene& m_scene;
  const Medium<Voxel>& m_medium;
  Domain m_domain;
  bool m_keepIsOne = false; ///< behind the clip's surface
};

/// Pixels with their neighbours, row 0 at the top.
struct Raster {
  int width, height;
  std::vector<Met> pixels;

  Met& at(int column, int row) {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(column)];
  }
  const Met& at(int column, int row) const { return const_cast<Raster&>(*this).at(column, row); }
};

/// True if two neighbouring rays see different things. `pitch`: mm between pixels.
bool differ(const Met& a, const Met& b, double pitch) {
  constexpr double colors = 0.08, slope = 4.0;
  if (((a.albedo - b.albedo).abs() > colors).any() || std::abs(a.hit - b.hit) > colors)
    return true;
  const double both = std::min(a.hit, b.hit);
  return both > 0.0 && std::abs(a.depth / a.hit - b.depth / b.hit) * both > slope * pitch;
}

bool isAtEdge(const Raster& raster, int column, int row, double pitch) {
  const Met& here = raster.at(column, row);
  const auto differsFrom = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < raster.width && y < raster.height &&
           differ(here, raster.at(x, y), pitch);
  };
  return differsFrom(column - 1, row) || differsFrom(column + 1, row) ||
         differsFrom(column, row - 1) || differsFrom(column, row + 1);
}

template <typename Voxel>
Raster marched(const RenderScene& scene, const March<Voxel>& march) {
  const int width = scene.camera.width(), height = scene.camera.height();
  Raster middle{width, height, {}};
  middle.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  tbb::parallel_for(0, height, [&](int row) {
    for (int column = 0; column < width; ++column)
      middle.at(column, row) = march.along(column + 0.5, row + 0.5);
  });
  Raster means = middle;
  tbb::parallel_for(0, height, [&](int row) {
    for (int column = 0; column < width; ++column) {
      if (!isAtEdge(middle, column, row, scene.camera.pixelPitch()))
        continue;
      Met mean;
      for (const double y : {0.25, 0.75})
        for (const double x : {0.25, 0.75})
          mean.add(march.along(column + x, row + y), 0.25);
      means.at(column, row) = mean;
    }
  });
  return means;
}

} // namespace

ExpectedFlight expectedFlight(const RenderScene& scene) {
  const Raster raster =
      withMedium(scene, [&]<typename Voxel>(const Medium<Voxel>& medium, const Tracker<Voxel>&) {
        return marched(scene, March<Voxel>(scene, medium));
      });
  ExpectedFlight flight;
  const auto plane = [&](Plane& values, auto&& valueOf) {
    values.reserve(raster.pixels.size());
    for (const Met& met : raster.pixels)
      values.push_back(static_cast<float>(valueOf(met)));
  };
  plane(flight.hit, [](const Met& met) { return met.hit; });
  plane(flight.depth, [](const Met& met) { return met.depth; });
  for (int c = 0; c < 3; ++c) {
    plane(flight.albedo[static_cast<std::size_t>(c)], [c](const Met& m) { return m.albedo[c]; });
    plane(flight.normal[static_cast<std::size_t>(c)], [c](const Met& m) { return m.normal[c]; });
  }
  return flight;
}

} // namespace fenestra
