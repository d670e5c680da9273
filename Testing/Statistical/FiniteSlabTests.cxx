// Finite slabs with isotropic scattering, against the integral equation of their source function,
// which is solved here. With optical depth t from the lit face, thickness T, single-scattering
// albedo w, and cosine mu of the direction to the slab's normal,
//   S(t) = w (J0(t) + 1/2 ∫_0^T E1(|t - s|) S(s) ds)
//   I(mu) = ∫_0^T S(t) exp(-t / mu) dt / mu           (from t = 0; likewise from t = T)
// (Chandrasekhar, Radiative Transfer, 1960, ch. I). J0 is the mean over all directions of
// the radiance that arrives unscattered: L/2 (E2(t) + E2(T - t)) for an environment of radiance L;
// F / (4 pi) exp(-t / mu0) for parallel light of irradiance F on a plane that faces the light.

#include "Slab.h"

#include <Eigen/LU>

#include <array>
#include <vector>

namespace fenestra::core::testing::FiniteSlabTests {
namespace {

/// E_n(x) = ∫_1^infinity exp(-x u) u^-n du.
double expIntegral2(double x) {
  return x > 0.0 ? std::exp(-x) + x * std::expint(-x) : 1.0; // E1(x) = -Ei(-x)
}
double expIntegral3(double x) {
  return 0.5 * (std::exp(-x) - x * expIntegral2(x));
}

struct SlabLight {
  double environment = 0.0; ///< radiance on both faces
  double irradiance = 0.0;  ///< from above, on a plane that faces the light
  double mu0 = 1.0;         ///< cosine of the parallel light to the normal
};

/// Piecewise constant source function. Its cells are finest at the faces, where its slope is
/// infinite. The equation is averaged over each cell (Galerkin), with exact integrals of the
/// kernel.
class SourceFunction {
public:
  SourceFunction(double thickness, double albedo, const SlabLight& light, int cells)
      : m_edges(cells + 1) {
    for (int i = 0; i <= cells; ++i)
      m_edges[i] = 0.5 * thickness * (1.0 - std::cos(pi * i / cells));
    Eigen::MatrixXd e3(cells + 1, cells + 1); // E3 of the distance between two edges
    for (int i = 0; i <= cells; ++i)
      for (int j = 0; j <= i; ++j)
        e3(i, j) = e3(j, i) = expIntegral3(m_edges[i] - m_edges[j]);
    Eigen::MatrixXd system(cells, cells);
    Eigen::VectorXd direct(cells);
    for (int i = 0; i < cells; ++i) {
      // ∫ over cell i ∫ over cell j of E1(|s - t|), by E3'' = E1.
      for (int j = 0; j < cells; ++j)
        system(i, j) = -0.5 * albedo * (e3(i, j + 1) + e3(i + 1, j) - e3(i, j) - e3(i + 1, j + 1));
      system(i, i) += (1.0 - albedo) * width(i);
      direct[i] = albedo * unscattered(i, light);
    }
    m_values = system.partialPivLu().solve(direct);
  }

  /// Radiance that leaves the upper or the lower face.
  double above(double mu) const { return emergent(mu, false); }
  double below(double mu) const { return emergent(mu, true); }

private:
  double width(int i) const { return m_edges[i + 1] - m_edges[i]; }
  double thickness() const { return m_edges[m_edges.size() - 1]; }

  /// ∫ of J0 (the unscattered light) over cell i.
  double unscattered(int i, const SlabLight& light) const {
    const double a = m_edges[i];
    const double b = m_edges[i + 1];
    const double sky = expIntegral3(a) - expIntegral3(b) + expIntegral3(thickness() - b) -
                       expIntegral3(thickness() - a);
    const double beam = light.mu0 * (std::exp(-a / light.mu0) - std::exp(-b / light.mu0));
    return 0.5 * light.environment * sky + light.irradiance / (4.0 * pi) * beam;
  }

  double emergent(double mu, bool isFromBelow) const {
    double sum = 0.0;
    for (int i = 0; i < m_values.size(); ++i) {
      const double near = isFromBelow ? thickness() - m_edges[i + 1] : m_edges[i];
      sum += m_values[i] * (std::exp(-near / mu) - std::exp(-(near + width(i)) / mu));
    }
    return sum;
  }

  Eigen::VectorXd m_edges, m_values;
};

struct View {
  double mu; ///< cosine to the slab's normal
  bool isFromBelow;
};

/// Bound on the relative error of EmergentRadiance.
constexpr double referenceError = 1e-4;
constexpr std::array<View, 3> views = {{{1.0, false}, {0.25, false}, {0.7, true}}};
const Rgb albedos(0.5, 0.9, 1.0);

/// Radiance that leaves slabs of `albedos`, by Richardson extrapolation from two grids: half
/// the cell size has a quarter of the error.
class EmergentRadiance {
public:
  EmergentRadiance(double thickness, const SlabLight& light, int cells = 240) {
    for (int c = 0; c < 3; ++c) {
      m_coarse.emplace_back(thickness, albedos[c], light, cells / 2);
      m_fine.emplace_back(thickness, albedos[c], light, cells);
    }
  }

  Rgb evaluate(const View& view) const {
    Rgb radiance;
    for (int c = 0; c < 3; ++c) {
      const auto fromGrid = [&](const std::vector<SourceFunction>& sources) {
        const SourceFunction& source = sources[static_cast<std::size_t>(c)];
        return view.isFromBelow ? source.below(view.mu) : source.above(view.mu);
      };
      radiance[c] = (4.0 * fromGrid(m_fine) - fromGrid(m_coarse)) / 3.0;
    }
    return radiance;
  }

private:
  std::vector<SourceFunction> m_coarse, m_fine;
};

TEST(EmergentRadiance, ErrorIsBelowItsBound) {
  for (const double thickness : {0.5, 2.0, 8.0})
    for (const SlabLight& light :
         {SlabLight{.environment = 1.0}, SlabLight{.irradiance = pi, .mu0 = 1.0},
          SlabLight{.irradiance = pi, .mu0 = 0.4}}) {
      const EmergentRadiance emergent(thickness, light);
      const EmergentRadiance refined(thickness, light, 360);
      for (const View& view : views) {
        const Rgb radiance = emergent.evaluate(view);
        EXPECT_LT((radiance / refined.evaluate(view) - 1.0).abs().maxCoeff(), referenceError);
        // Albedo 1: all radiance is 1, of which exp(-T / mu) passes the slab unscattered.
        if (light.environment > 0.0) {
          EXPECT_NEAR(radiance[2], 1.0 - std::exp(-thickness / view.mu), 1e-9);
        }
      }
    }
}

struct SlabCase {
  const char* name;
  std::uint64_t seed;
  SlabLight light;
};

class FiniteSlab : public ::testing::TestWithParam<std::tuple<double, SlabCase>> {};

TEST_P(FiniteSlab, RadianceSolvesTheIntegralEquation) {
  const auto& [thickness, c] = GetParam();
  TestScene scene = makeWideSlab(thickness, albedos);
  scene.lights.clear();
  if (c.light.environment > 0.0)
    scene.lights.push_back(EnvironmentLight{.radiance = Rgb::Constant(c.light.environment)});
  if (c.light.irradiance > 0.0)
    scene.lights.push_back(DirectionalLight{.direction = downwardDirection(c.light.mu0, 0.8),
                                            .irradiance = Rgb::Constant(c.light.irradiance)});
  const EmergentRadiance emergent(thickness, c.light);
  const std::uint64_t samples = thickness > 5.0 ? 600 : 2000; // long paths in thick slabs
  std::uint64_t seed = c.seed + static_cast<std::uint64_t>(10.0 * thickness);
  for (const View& view : views) {
    SCOPED_TRACE(std::to_string(view.mu) + (view.isFromBelow ? " from below" : " from above"));
    aimCamera(scene, downwardDirection(view.isFromBelow ? -view.mu : view.mu));
    // Very little light crosses eight free paths of a dark medium: its mean is too noisy for 0.01.
    const double maxRelativeError = view.isFromBelow && thickness > 5.0 ? 0.3 : 0.01;
    expectMean(renderMean(scene, samples, seed++), emergent.evaluate(view), maxRelativeError,
               referenceError);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Slabs, FiniteSlab,
    ::testing::Combine(
        ::testing::Values(0.5, 2.0, 8.0),
        ::testing::Values(SlabCase{"environment", 1000, {.environment = 1.0}},
                          SlabCase{"normal", 2000, {.irradiance = pi, .mu0 = 1.0}},
                          SlabCase{"oblique", 3000, {.irradiance = pi, .mu0 = 0.4}},
                          SlabCase{
                              "both", 4000, {.environment = 0.3, .irradiance = 2.0, .mu0 = 0.7}})),
    [](const auto& info) {
      return std::string(std::get<1>(info.param).name) +
             std::to_string(static_cast<int>(10.0 * std::get<0>(info.param)));
    });

} // namespace
} // namespace fenestra::core::testing::FiniteSlabTests
