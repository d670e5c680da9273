#include "Oracle.h"

#include "Clipping.h"
#include "Lights.h"
#include "Scatter.h"
#include "Segments.h"

#include <tbb/parallel_for.h>

#include <stdexcept>

namespace fenestra::core::oracle {
namespace {

using Component = ComponentsDescription::Component;

class Tracer {
public:
  explicit Tracer(const OracleScene& scene)
      : m_scene(scene),
        m_view(scene.pose),
        m_medium(scene.volume, scene.transfer, scene.crop),
        m_clipping(scene.clip, m_view, m_medium),
        m_lights(scene.lights, scene.volume.grid, m_view) {
    if (scene.style)
      m_styledFocus.emplace(scene.style->focus);
    if (scene.components)
      m_segments.emplace(*scene.components);
    if (isMixed())
      m_components = scene.components->components;
    else
      m_components.push_back({scene.transfer});
    for (const Component& component : m_components)
      m_majorant = std::max(m_majorant, findMaxExtinction(component.transfer));
    if (scene.background.kind == Background::Kind::gradient)
      throw std::invalid_argument("the oracle does not support gradient backgrounds");
  }

  /// Traces one path through a raster position, in pixels from the image's top left corner.
  PathEstimate tracePath(double column, double row, Generator& generator) const {
    const double pitch = 2.0 * m_view.halfHeight / m_scene.height;
    Ray ray = m_view.makeRay((column - 0.5 * m_scene.width) * pitch,
                             (0.5 * m_scene.height - row) * pitch);
    PathEstimate result;
    double distance = findCollision(ray, generator);
    if (distance == infinity)
      return sampleBackground(ray);
    result.collides = true;
    result.depth = m_view.depth(ray.at(distance));
    Collision collision = sampleComponent(ray.at(distance), generator);
    result.albedo = collision.albedo;

    Rgb throughput = Rgb::Ones();
    for (std::uint64_t scattered = 0; scattered < m_scene.bounces; ++scattered) {
      const Vec3 point = ray.at(distance);
      const Scatterer scatterer = makeScatterer(collision, point, ray.direction, generator);
      result.radiance += throughput * (estimateParallelLight(point, scatterer, generator) +
                                       estimateAreaLight(point, scatterer, generator));
      const Vec3 outgoing = scatterer.sample(generator);
      throughput *= scatterer.f(outgoing) / scatterer.pdf(outgoing);
      if (!survivesRoulette(throughput, generator))
        break;
      ray = {point, outgoing};
      distance = findCollision(ray, generator);
      if (distance == infinity) {
        result.radiance += throughput * m_lights.environment(ray.direction);
        break;
      }
      collision = sampleComponent(ray.at(distance), generator);
    }
    return result;
  }

  const Clipping& clipping() const { return m_clipping; }

private:
  /// Properties of the medium that a collision samples.
  struct Collision {
    std::size_t component;
    Rgb albedo;
  };

  bool isMixed() const { return m_scene.components && !m_scene.components->isTint; }

  /// Distance to the next real collision, by delta tracking with one majorant for the complete
  /// volume. Each tentative collision is tested at its own point.
  double findCollision(const Ray& ray, Generator& generator) const {
    const Interval part = m_medium.boxInterval(ray.origin, ray.direction);
    if (part.isEmpty() || m_majorant == 0.0)
      return infinity;
    double t = part.begin;
    for (;;) {
      t += -std::log(1.0 - uniform(generator)) / m_majorant;
      if (t >= part.end)
        return infinity;
      const Vec3 point = ray.at(t);
      if (!m_medium.contains(point))
        continue;
      if (uniform(generator) * m_majorant < addUp(computeExtinctions(point)))
        return t;
    }
  }

  /// Extinction, mm^-1, of each component: that of its transfer function times clip weight (1 if
  /// unclipped), context style and label weight.
  Segments::Weights computeExtinctions(const Vec3& point) const {
    Segments::Weights all{};
    Segments::Weights fractions{1.0};
    if (isMixed())
      fractions = m_segments->at(point);
    const double weight = m_clipping.clipWeight(point), style = styleFactor(point);
    const double scalar = m_medium.scalar(point);
    for (std::size_t c = 0; c < m_components.size(); ++c)
      if (fractions[c] > 0.0)
        all[c] = (m_components[c].isClipped ? weight : 1.0) * style * fractions[c] *
                 m_medium.extinction(m_components[c].transfer, point, scalar);
    return all;
  }

  static double addUp(const Segments::Weights& all) {
    double sum = 0.0;
    for (const double extinction : all)
      sum += extinction;
    return sum;
  }

  /// Samples one component in proportion to the extinctions.
  Collision sampleComponent(const Vec3& point, Generator& generator) const {
    std::size_t sampled = 0;
    if (isMixed()) {
      const Segments::Weights all = computeExtinctions(point);
      double remaining = uniform(generator) * addUp(all);
      while (sampled + 1 < m_components.size() && remaining >= all[sampled])
        remaining -= all[sampled++];
    }
    return {sampled, albedo(sampled, point)};
  }

  PathEstimate sampleBackground(const Ray& ray) const {
    PathEstimate result;
    if (m_scene.background.kind == Background::Kind::environment)
      result.radiance = m_lights.environment(ray.direction);
    else if (m_scene.background.kind == Background::Kind::color)
      result.radiance = m_scene.background.color;
    return result;
  }

  Scatterer makeScatterer(const Collision& collision, const Vec3& point, const Vec3& incoming,
                          Generator& generator) const {
    const Component& component = m_components[collision.component];
    if (component.transfer.shading) {
      Vec3 gradient = m_medium.spansPerMm(point);
      if (component.isClipped)
        gradient += m_clipping.cutGradient(point);
      if (component.interfaceWeight > 0.0)
        gradient += component.interfaceWeight * m_segments->gradient(collision.component, point);
      if (uniform(generator) <
          m_medium.surfaceProbability(component.transfer, point, gradient.norm()))
        return Scatterer::makeSurface(incoming, collision.albedo, gradient,
                                      *component.transfer.shading);
    }
    return Scatterer::makePhase(incoming, collision.albedo, component.transfer.g);
  }

  bool isStyled(const Vec3& point) const { return m_styledFocus && m_styledFocus->at(point) < 0.5; }
  double styleFactor(const Vec3& point) const {
    return isStyled(point) ? m_scene.style->extinction : 1.0;
  }
  /// Albedo of a component; for a tint the mean over all, by the 16th power of their label
  /// weights.
  Rgb albedo(std::size_t number, const Vec3& point) const {
    const double scalar = m_medium.scalar(point);
    Rgb own = evaluate(m_components[number].transfer.albedo, scalar);
    if (m_segments && !isMixed()) {
      const Segments::Weights fractions = m_segments->at(point);
      own.setZero();
      double total = 0.0;
      for (std::size_t c = 0; c < m_scene.components->components.size(); ++c) {
        const double weight = std::pow(fractions[c], 16.0);
        own += weight * evaluate(m_scene.components->components[c].transfer.albedo, scalar);
        total += weight;
      }
      own /= total;
    }
    if (!isStyled(point))
      return own;
    const Rgb gray = Rgb::Constant(own.matrix().dot(Vec3(0.2126, 0.7152, 0.0722)));
    return m_scene.style->saturation * own + (1.0 - m_scene.style->saturation) * gray;
  }

  /// Radiance from directional lights, scattered toward the camera. A light contributes in full, or
  /// 0 if a free flight toward it collides.
  Rgb estimateParallelLight(const Vec3& point, const Scatterer& scatterer,
                            Generator& generator) const {
    Rgb sum = Rgb::Zero();
    for (const DirectionalLight& light : m_lights.directionals()) {
      const Vec3 toward = -light.direction.normalized();
      if (findCollision({point, toward}, generator) == infinity)
        sum += scatterer.f(toward) * light.irradiance;
    }
    return sum;
  }

  /// Radiance from area lights, by one probe ray. Its direction is sampled with equal probability
  /// from the lights or from scattering; it adds all lights that it hits.
  Rgb estimateAreaLight(const Vec3& point, const Scatterer& scatterer, Generator& generator) const {
    if (!m_lights.hasAreas())
      return Rgb::Zero();
    const bool isFromLights = uniform(generator) < 0.5;
    const Ray probe{point, isFromLights ? m_lights.sampleArea(point, generator)
                                        : scatterer.sample(generator)};
    const Rgb light = m_lights.areaRadiance(probe, findCollision(probe, generator));
    const double density = 0.5 * m_lights.areaPdf(probe) + 0.5 * scatterer.pdf(probe.direction);
    return light * scatterer.f(probe.direction) / density;
  }

  /// Russian roulette at low throughput. (Analog absorption in a dark medium would leave too few
  /// bright paths to estimate the error of their mean.)
  static bool survivesRoulette(Rgb& throughput, Generator& generator) {
    constexpr double threshold = 0.05;
    const double most = throughput.maxCoeff();
    if (most >= threshold)
      return true;
    if (uniform(generator) * threshold >= most)
      return false;
    throughput *= threshold / most;
    return true;
  }

  const OracleScene& m_scene;
  View m_view;
  Medium m_medium;
  Clipping m_clipping;
  std::optional<FocusField> m_styledFocus;
  std::optional<Segments> m_segments;
  std::vector<Component> m_components; ///< of the medium; with a tint, the volume's own alone
  double m_majorant = 0.0;             ///< maximum extinction anywhere, mm^-1
  Lights m_lights;
};

} // namespace

Estimates render(const OracleScene& scene, std::uint64_t samples, std::uint64_t seed,
                 std::vector<double>* depths) {
  const Tracer tracer(scene);
  if (depths)
    *depths = tracer.clipping().depths();
  Estimates estimates(scene.width, scene.height, samples);
  tbb::parallel_for(0, scene.width * scene.height, [&](int pixel) {
    std::seed_seq words{seed & 0xffffffffU, seed >> 32U, static_cast<std::uint64_t>(pixel)};
    Generator generator(words);
    for (std::uint64_t i = 0; i < samples; ++i) {
      const double column = pixel % scene.width + uniform(generator);
      const double row = pixel / scene.width + uniform(generator);
      estimates.pixels[static_cast<std::size_t>(pixel)].add(
          tracer.tracePath(column, row, generator));
    }
  });
  return estimates;
}

} // namespace fenestra::core::oracle
