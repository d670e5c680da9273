// Filter input from a film and its scene, and the denoised image.

#include "denoise/features/Denoising.h"

#include "MedicalFiles.h"
#include "scene/PreparedScene.h"

#include <stdexcept>

namespace fenestra::core::DenoisingTests {
namespace {

/// Ball of a thin medium in a box of 16^3 voxels: many rays cross it without a collision.
class Denoising : public ::testing::Test {
protected:
  Denoising() {
    std::vector<std::int16_t> voxels;
    for (int z = 0; z < edge; ++z)
      for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x) {
          const double radius = (Vec3(x, y, z) - Vec3::Constant(7.5)).norm();
          voxels.push_back(static_cast<std::int16_t>(radius < 5.0 ? 100.0 + 5.0 * x : 0.0));
        }
    FileGeometry geometry;
    geometry.size = {edge, edge, edge};
    writeFile(folder / "volume.nrrd", voxels, geometry);
    folder.write("haze.json",
                 R"({"extinction": [[50, 0], [200, 0.2]], "albedo": [[0, 0.8, 0.6, 0.4]]})");
    request.input = folder / "volume.nrrd";
    request.transfer = folder / "haze.json";
    request.width = request.height = 48;
    request.features = true;
  }

  static Film renderFilm(const PreparedScene& scene, std::uint64_t seed = 0,
                         std::uint64_t samples = 2) {
    RenderSettings settings;
    settings.samples = samples;
    settings.seed = seed;
    settings.path.background = {Background::Kind::color, Rgb::Constant(0.5)};
    RenderMonitor monitor;
    return render(scene.view(), settings, monitor).film;
  }

  static constexpr int edge = 16;
  TemporaryFolder folder;
  RenderRequest request;
};

TEST_F(Denoising, InactivePixelsAreTheEmptyOnesWhateverTheSamplesHit) {
  const PreparedScene scene(request);
  const Film film = renderFilm(scene);
  const FilterInput input = makeFilterInput(film, scene.view(), *scene.features());
  std::size_t missed = 0, deterministic = 0;
  for (std::size_t i = 0; i < film.pixelCount(); ++i) {
    const PixelSums& pixel = film.pixels()[i];
    const bool isEmpty = pixel.isDeterministic || scene.features()->hit[i] == 0.0F;
    EXPECT_TRUE(isEmpty || input.isActive[i] != 0);
    EXPECT_FALSE(pixel.isDeterministic && input.isActive[i] != 0);
    missed += input.isActive[i] != 0 && pixel.collidedSamples == 0;
    deterministic += pixel.isDeterministic;
  }
  EXPECT_GT(missed, 100U);
  EXPECT_GT(deterministic, 100U);
}

TEST_F(Denoising, FeaturesDoNotDependOnSamples) {
  const PreparedScene scene(request);
  const FilterInput one = makeFilterInput(renderFilm(scene, 1), scene.view(), *scene.features());
  const FilterInput other = makeFilterInput(renderFilm(scene, 2), scene.view(), *scene.features());
  EXPECT_GE(one.features.size(), 8U);
  EXPECT_EQ(one.features, other.features);
  EXPECT_NE(one.even, other.even);
}

TEST_F(Denoising, DependentHalfBuffersAreRejected) {
  const PreparedScene scene(request);
  EXPECT_THROW(makeFilterInput(Film(48, 48, false), scene.view(), *scene.features()),
               std::logic_error);
}

TEST_F(Denoising, HalfBuffersAverageToTheImage) {
  const PreparedScene scene(request);
  const Film film = renderFilm(scene, 3, 4);
  const FilterInput input = makeFilterInput(film, scene.view(), *scene.features());
  for (std::size_t i = 0; i < film.pixelCount(); ++i)
    ASSERT_NEAR(0.5 * static_cast<double>(input.even[1][i] + input.odd[1][i]),
                film.pixels()[i].mean[1], 1e-6);
}

double sumSquaredErrors(const FilteredImage& image, const Film& reference) {
  double sum = 0.0;
  for (std::size_t i = 0; i < reference.pixelCount(); ++i)
    sum += std::pow(static_cast<double>(image.color[0][i]) - reference.pixels()[i].mean[0], 2.0);
  return sum;
}

TEST_F(Denoising, FilteredImageIsCloserToTheReference) {
  const PreparedScene scene(request);
  const Film reference = renderFilm(scene, 9, 512), film = renderFilm(scene, 1, 4);
  const FilteredImage filtered = denoise(film, scene.view(), *scene.features());
  double raw = 0.0;
  for (std::size_t i = 0; i < film.pixelCount(); ++i)
    raw += std::pow(film.pixels()[i].mean[0] - reference.pixels()[i].mean[0], 2.0);
  EXPECT_LT(sumSquaredErrors(filtered, reference), 0.1 * raw);
  EXPECT_EQ(filtered.error[0].size(), film.pixelCount());
}

TEST_F(Denoising, InactivePixelsStayRawAtAnySampleCount) {
  const PreparedScene scene(request);
  const Film film = renderFilm(scene, 4, 3);
  const FilterInput input = makeFilterInput(film, scene.view(), *scene.features());
  const FilteredImage filtered = denoise(film, scene.view(), *scene.features());
  for (std::size_t i = 0; i < film.pixelCount(); ++i) {
    const auto mean = static_cast<float>(film.pixels()[i].mean[1]);
    ASSERT_TRUE(input.isActive[i] != 0 || filtered.color[1][i] == mean);
  }
}

TEST_F(Denoising, OnePixelWithOneSampleDisablesHalfBuffersButNotFiltering) {
  const PreparedScene scene(request);
  Film film = renderFilm(scene, 4, 2);
  std::size_t first = 0;
  while (film.pixels()[first].isDeterministic)
    ++first;
  PathSample sample;
  sample.radiance = Rgb::Ones();
  film.at(static_cast<int>(first) % 48, static_cast<int>(first) / 48) = PixelSums();
  film.at(static_cast<int>(first) % 48, static_cast<int>(first) / 48).add(sample);
  const FilterInput input = makeFilterInput(film, scene.view(), *scene.features());
  EXPECT_FALSE(input.hasHalfBuffers);
  for (std::size_t i = 0; i < film.pixelCount(); ++i)
    ASSERT_EQ(input.even[0][i], static_cast<float>(film.pixels()[i].mean[0]));
  EXPECT_TRUE(denoise(film, scene.view(), *scene.features()).error[0].empty());
}

} // namespace
} // namespace fenestra::core::DenoisingTests
