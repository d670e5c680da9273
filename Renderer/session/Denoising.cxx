#include "session/Denoising.h"

#include "session/Picture.h"

#include <algorithm>
#include <stdexcept>

namespace fenestra {
namespace {

/// Closes pixels around which the march met nothing: no window spreads a silhouette into the
/// background. Never by what the samples met: a mask that knows their noise makes the told error a
/// lie.
void closeEmpty(const ExpectedFlight& flight, FilterInput& input) {
  const auto hit = [&](int x, int y) {
    return flight.hit[static_cast<std::size_t>(y) * static_cast<std::size_t>(input.width) +
                      static_cast<std::size_t>(x)] > 0.0F;
  };
  for (int row = 0; row < input.height; ++row)
    for (int column = 0; column < input.width; ++column) {
      bool isEmpty = true;
      for (int y = std::max(row - 1, 0); y <= std::min(row + 1, input.height - 1); ++y)
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, input.width - 1); ++x)
          isEmpty = isEmpty && !hit(x, y);
      if (isEmpty)
        input.isOpen[static_cast<std::size_t>(row) * static_cast<std::size_t>(input.width) +
                     static_cast<std::size_t>(column)] = 0;
    }
}

/// Halves of a pixel; its mean twice below two samples.
Halves halvesOf(const PixelSums& pixel) {
  return pixel.samples > 1 ? pixel.halves()
                           : Halves{pixel.mean, pixel.mean, pixel.alpha, pixel.alpha};
}

void addHalves(const Film& film, FilterInput& input) {
  const std::size_t count = film.pixelCount();
  input.isOpen.resize(count);
  for (std::size_t c = 0; c < 4; ++c) {
    input.even[c].resize(count);
    input.odd[c].resize(count);
    if (c < 3)
      input.variance[c].resize(count);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const PixelSums& pixel = film.pixels()[i];
    const Halves halves = halvesOf(pixel);
    const Rgb variance = pixel.standardError().square();
    input.isOpen[i] = !pixel.isCertain;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto channel = static_cast<int>(c);
      input.even[c][i] = static_cast<float>(halves.even[channel]);
      input.odd[c][i] = static_cast<float>(halves.odd[channel]);
      input.variance[c][i] = static_cast<float>(variance[channel]);
    }
    input.even[3][i] = static_cast<float>(halves.evenAlpha);
    input.odd[3][i] = static_cast<float>(halves.oddAlpha);
  }
}

/// Sums of depth as distances from their median, mm: a pixel that meets little has little.
Plane centredDepth(const ExpectedFlight& flight) {
  std::vector<float> depths;
  for (std::size_t i = 0; i < flight.hit.size(); ++i)
    if (flight.hit[i] > 0.5F)
      depths.push_back(flight.depth[i] / flight.hit[i]);
  if (depths.empty())
    return flight.depth;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::ranges::nth_element(depths, middle);
  Plane plane = flight.depth;
  for (std::size_t i = 0; i < plane.size(); ++i)
    plane[i] -= *middle * flight.hit[i];
  return plane;
}

/// Central differences to the neighbours `step` pixels before and after; 0 at the border.
Plane slopeOf(const Plane& plane, int width, int height, bool down) {
  Plane slope(plane.size(), 0.0F);
  const auto row = static_cast<std::size_t>(width);
  const std::size_t step = down ? row : 1;
  for (int y = down ? 1 : 0; y < height - (down ? 1 : 0); ++y)
    for (int x = down ? 0 : 1; x < width - (down ? 0 : 1); ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x);
      slope[i] = plane[i + step] - plane[i - step];
    }
  return slope;
}

/// Depth of the clip's surface where there is one, else that of the nearest pixel before it in the
/// row: rays that the clip ends see nothing of it.
Plane boundedClip(const Camera& camera, const Clip& clip) {
  Plane plane = clipPlane(camera, clip);
  float last = static_cast<float>(camera.targetDepth());
  for (float& depth : plane)
    depth = last = std::isfinite(depth) ? depth : last;
  return plane;
}

void addFeatures(const Scene& scene, const ExpectedFlight& flight, FilterInput& input) {
  for (const Plane& plane : flight.albedo)
    input.features.push_back(plane);
  // Where light scatters at surfaces, what it meets there is told by their normals.
  for (const Plane& plane : scene.transfer().shading ? flight.facing : flight.normal)
    input.features.push_back(plane);
  input.features.push_back(flight.light);
  const Plane depth = centredDepth(flight);
  input.features.push_back(slopeOf(depth, input.width, input.height, false));
  input.features.push_back(slopeOf(depth, input.width, input.height, true));
  input.features.push_back(depth);
  if (!std::holds_alternative<ClipNone>(scene.clip()))
    input.features.push_back(boundedClip(scene.camera(), scene.clip()));
}

/// Where a picture's pixels lie in the picture of another eye.
class OtherView {
public:
  OtherView(const Scene& before, const Scene& scene)
      : m_width(before.camera().width()), m_height(before.camera().height()) {
    const Camera &camera = scene.camera(), &other = before.camera();
    const ExpectedFlight& flight = *scene.flight();
    m_places.reserve(flight.hit.size());
    for (int row = 0; row < camera.height(); ++row)
      for (int column = 0; column < camera.width(); ++column) {
        const std::size_t i = m_places.size();
        const Ray ray = camera.ray(column + 0.5, row + 0.5);
        const double depth = static_cast<double>(flight.depth[i] / flight.hit[i]);
        const Vec3 point = ray.at(depth / camera.depthPerLength(ray));
        m_places.push_back(flight.hit[i] > 0.5F ? placeOf(point, other, *before.flight())
                                                : Place());
      }
  }

  /// `plane` of the other picture, less its mean; 0 where the other eye saw nothing of a pixel.
  Plane seen(const Plane& plane) const {
    Plane result(m_places.size(), 0.0F);
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < result.size(); ++i)
      if (m_places[i].column >= 0) {
        result[i] = between(plane, m_places[i]);
        sum += static_cast<double>(result[i]);
        count += 1.0;
      }
    const auto mean = static_cast<float>(sum / std::max(count, 1.0));
    for (std::size_t i = 0; i < result.size(); ++i)
      if (m_places[i].column >= 0)
        result[i] -= mean;
    return result;
  }

private:
  /// Between four pixels, of which (column, row) is the upper left; column < 0: nowhere.
  struct Place {
    int column = -1, row = -1;
    float across = 0.0F, down = 0.0F;
  };

  Place placeOf(const Vec3& point, const Camera& camera, const ExpectedFlight& flight) const {
    const Vec3 view = camera.toView(point);
    const bool perspective = camera.pose().projection == Projection::perspective;
    if (perspective && !(view.z() > 0.0))
      return {};
    const Vec2 plane = view.head<2>() * (perspective ? camera.targetDepth() / view.z() : 1.0);
    const Vec2 raster = camera.toRaster(plane).array() - 0.5;
    if (!(raster.x() >= 0.0 && raster.x() < m_width - 1 && raster.y() >= 0.0 &&
          raster.y() < m_height - 1))
      return {};
    Place place{static_cast<int>(raster.x()), static_cast<int>(raster.y())};
    place.across = static_cast<float>(raster.x() - place.column);
    place.down = static_cast<float>(raster.y() - place.row);
    // The other eye saw the point if its own expected depth is about that of the point.
    constexpr double tolerance = 3.0; // pixels
    const double hit = static_cast<double>(between(flight.hit, place));
    const double depth = static_cast<double>(between(flight.depth, place)) / hit;
    return std::abs(depth - view.z()) <= tolerance * camera.pixelPitch() ? place : Place();
  }

  float between(const Plane& plane, const Place& place) const {
    const auto row = static_cast<std::size_t>(m_width);
    const float* at =
        &plane[static_cast<std::size_t>(place.row) * row + static_cast<std::size_t>(place.column)];
    const float upper = at[0] + place.across * (at[1] - at[0]);
    const float lower = at[row] + place.across * (at[row + 1] - at[row]);
    return upper + place.down * (lower - upper);
  }

  int m_width, m_height; ///< of the other picture
  std::vector<Place> m_places;
};

bool hasHalves(const Film& film) {
  return std::ranges::all_of(
      film.pixels(), [](const PixelSums& pixel) { return pixel.isCertain || pixel.samples > 1; });
}

} // namespace

FilterInput filterInput(const Film& film, const Scene& scene) {
  if (!film.hasIndependentHalves())
    throw std::logic_error("a film without independent halves cannot be filtered");
  FilterInput input{film.width(), film.height(), {}, {}, {}, {}, {}};
  addHalves(film, input);
  if (scene.flight()) {
    addFeatures(scene, *scene.flight(), input);
    closeEmpty(*scene.flight(), input);
  }
  return input;
}

FilteredPicture denoised(const Film& film, const Scene& scene, const std::vector<Plane>& history) {
  FilterInput input = filterInput(film, scene);
  input.features.insert(input.features.end(), history.begin(), history.end());
  return filtered(std::move(input), hasHalves(film));
}

std::vector<Plane> seenAgain(const FilteredPicture& picture, const Scene& before,
                             const Scene& scene) {
  const OtherView view(before, scene);
  std::vector<Plane> planes;
  for (const Plane& light : picture.light)
    if (!light.empty())
      planes.push_back(view.seen(light));
  return planes;
}

} // namespace fenestra
