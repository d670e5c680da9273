// Unusual voxel values of every type: the reader must store the documented replacement, and the
// image must equal that of a file with the replaced values. Also the limit of a scene's extinction.

#include "Approx.h"
#include "StressSupport.h"
#include "Unit/MedicalFiles.h"
#include "files/medical/VolumeReader.h"
#include "scene/PreparedScene.h"

namespace fenestra::core::testing::VoxelStressTests {
namespace {

/// Geometry of 4x4x4 voxels of 1 mm.
const FileGeometry cube{.size = {4, 4, 4}};

/// Ordinary values 0 to 94 (steps of 1.5 if the type has fractions), and the values `unusual` among
/// them.
template <typename T>
std::vector<T> makeSamples(const std::vector<T>& unusual) {
  std::vector<T> samples(64);
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = static_cast<T>(1.5 * static_cast<double>(i * 29 % 64));
  for (std::size_t i = 0; i < unusual.size(); ++i)
    samples[7 + 5 * i] = unusual[i];
  return samples;
}

/// Documented replacement: NaN and -infinity become the minimum finite value, +infinity the
/// maximum; values beyond float are clamped to its range.
template <typename T>
std::vector<float> replaceUnusual(const std::vector<T>& samples) {
  std::vector<long double> finite;
  for (const T x : samples)
    if (std::isfinite(static_cast<long double>(x)))
      finite.push_back(static_cast<long double>(x));
  const long double least = *std::min_element(finite.begin(), finite.end());
  const long double greatest = *std::max_element(finite.begin(), finite.end());
  constexpr long double most = std::numeric_limits<float>::max();
  std::vector<float> result;
  for (const T sample : samples) {
    const auto x = static_cast<long double>(sample);
    const long double value = std::isfinite(x) ? x : x > 0.0L ? greatest : least;
    result.push_back(static_cast<float>(std::clamp(value, -most, most)));
  }
  return result;
}

Film renderFilm(RenderRequest request, int samples) {
  request.width = 8;
  request.height = 8;
  const PreparedScene scene(request);
  RenderSettings settings;
  settings.samples = static_cast<std::uint64_t>(scaleSamples(samples));
  RenderMonitor monitor;
  return render(scene.view(), settings, monitor).film;
}

/// Image with the command line's defaults, in an environment of 1.
Film renderFile(const std::filesystem::path& volume, const std::optional<std::string>& transfer) {
  RenderRequest request;
  request.input = volume;
  request.transfer = transfer;
  request.environment = Rgb::Ones();
  return renderFilm(request, 16);
}

/// Compares the stored voxels and the images, with a given and with the default transfer function.
template <typename T>
void expectReplaced(const std::vector<T>& unusual) {
  const TemporaryFolder folder;
  const std::vector<T> samples = makeSamples(unusual);
  const std::vector<float> expected = replaceUnusual(samples);
  writeFile(folder / "odd.nrrd", samples, cube);
  writeFile(folder / "easy.nrrd", expected, cube);
  const Volume volume = readVolume(folder / "odd.nrrd");
  std::visit(
      [&](const auto& voxels) {
        ASSERT_EQ(voxels.size(), expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i)
          ASSERT_EQ(static_cast<double>(voxels[i]), static_cast<double>(expected[i])) << i;
      },
      volume.voxels);
  const auto [least, greatest] = std::minmax_element(expected.begin(), expected.end());
  EXPECT_EQ(volume.minimum, static_cast<double>(*least));
  EXPECT_EQ(volume.maximum, static_cast<double>(*greatest));

  const std::string transferFile =
      folder.write("transfer.json", R"({"extinction": [[-50, 0.1], [20, 0], [80, 1.5], [80, 0.4]],
                                    "albedo": [[0, 0.9, 0.5, 0.1], [90, 0.2, 0.8, 0.9]]})");
  for (const std::optional<std::string>& transfer :
       {std::optional(transferFile), std::optional<std::string>{}}) {
    const Film film = renderFile(folder / "odd.nrrd", transfer);
    expectEqualBits(film, renderFile(folder / "easy.nrrd", transfer));
    double sum = 0.0;
    for (const PixelSums& pixel : film.pixels()) {
      ASSERT_TRUE((pixel.mean >= 0.0).all() && allFinite(pixel.mean));
      sum += pixel.mean.sum();
    }
    EXPECT_GT(sum, 0.0) << "a black image tests nothing";
  }
}

template <typename T>
std::vector<T> makeExtremes() {
  using Limits = std::numeric_limits<T>;
  return {Limits::max(), Limits::lowest(), static_cast<T>(Limits::max() - 1),
          static_cast<T>(Limits::lowest() + 1)};
}

TEST(UnusualVoxels, ExtremeIntegersAreKeptOrRounded) {
  expectReplaced<std::int8_t>(makeExtremes<std::int8_t>());
  expectReplaced<std::uint8_t>(makeExtremes<std::uint8_t>());
  expectReplaced<std::int16_t>(makeExtremes<std::int16_t>());
  expectReplaced<std::uint16_t>(makeExtremes<std::uint16_t>());
  expectReplaced<std::int32_t>(makeExtremes<std::int32_t>());
  expectReplaced<std::uint32_t>(makeExtremes<std::uint32_t>());
  expectReplaced<std::int64_t>(makeExtremes<std::int64_t>());
  expectReplaced<std::uint64_t>(makeExtremes<std::uint64_t>());
}

template <typename T>
void expectFloatingReplaced() {
  using Limits = std::numeric_limits<T>;
  const T nan = Limits::quiet_NaN(), inf = Limits::infinity(), tiny = Limits::denorm_min();
  expectReplaced<T>({nan});
  expectReplaced<T>({-nan, nan, nan, nan, nan});
  expectReplaced<T>({inf});
  expectReplaced<T>({-inf});
  expectReplaced<T>({nan, inf, -inf});
  expectReplaced<T>({tiny, -tiny, Limits::min(), -Limits::min(), T(-0.0)});
  expectReplaced<T>({Limits::max()});
  expectReplaced<T>({Limits::lowest()});
  expectReplaced<T>({Limits::max(), Limits::lowest(), nan, inf, -inf, tiny});
  expectReplaced<T>({T(1e30), T(-1e30), nan});
  expectReplaced<T>({T(1e-30), nan});
}

TEST(UnusualVoxels, NonFiniteFloatsAreReplaced) {
  expectFloatingReplaced<float>();
}

TEST(UnusualVoxels, NonFiniteDoublesAreReplaced) {
  expectFloatingReplaced<double>();
  expectReplaced<double>({1e-310, 1e-40, -1e-40, 1e39, -1e300});
}

TEST(UnusualVoxels, NoFiniteVoxelIsErrorOneIsConstantVolume) {
  const TemporaryFolder folder;
  const double nan = std::nan("");
  writeFile(folder / "none.nrrd", std::vector<double>(64, nan), cube);
  expectRefused(folder / "none.nrrd", "non-finite-voxels",
                [&] { renderFile(folder / "none.nrrd", {}); });
  std::vector<double> one(64, nan);
  one[63] = -1000.0;
  writeFile(folder / "one.nrrd", one, cube);
  writeFile(folder / "easy.nrrd", std::vector<double>(64, -1000.0), cube);
  expectEqualBits(renderFile(folder / "one.nrrd", {}), renderFile(folder / "easy.nrrd", {}));
}

TEST(ConstantFiles, DefaultTransferDoesNotDependOnValue) {
  const TemporaryFolder folder;
  const auto renderConstant = [&](double value) {
    writeFile(folder / "v.nrrd", std::vector<float>(64, static_cast<float>(value)), cube);
    return renderFile(folder / "v.nrrd", {});
  };
  const Film usual = renderConstant(100.0);
  EXPECT_GT(usual.at(4, 4).mean.sum(), 0.0);
  for (const double value : {0.0, -1000.0, 1e-45, 3e38, -3e38, 255.0})
    expectEqualBits(renderConstant(value), usual);
}

// ---- limit of a scene's extinction

std::string makeDenseTransfer(double extinction) {
  std::ostringstream text;
  text << R"({"extinction": [[0, 0], [10, )" << extinction
       << R"(]], "albedo": [[0, 0.9, 0.9, 0.9]]})";
  return text.str();
}

TEST(ExtinctionLimit, OpticalDepthAboveTenMillionIsError) {
  const TemporaryFolder folder;
  writeFile(folder / "v.nrrd", std::vector<std::uint8_t>(64, 10), cube);
  const double limit = 1e7 / (4.0 * std::sqrt(3.0)); // across the diagonal of 4 mm
  for (const double extinction : {1.001 * limit, 1e8, 1e30}) {
    const auto transferFile = folder.write("over.json", makeDenseTransfer(extinction));
    expectRefused(transferFile, "excessive-extinction: extinction",
                  [&] { renderFile(folder / "v.nrrd", transferFile); });
  }
  const auto transferFile = folder.write("at.json", makeDenseTransfer(0.999 * limit));
  // Every camera ray hits a half-space of albedo 0.9 head-on: Chandrasekhar's reflectance.
  const Estimate estimate = estimateMean(renderFile(folder / "v.nrrd", transferFile));
  EXPECT_GT(estimate.mean, 0.25); // rays that miss the volume are black
  RenderRequest request;
  request.input = folder / "v.nrrd";
  request.transfer = transferFile;
  request.density = 1.01;
  expectRefused(transferFile, "excessive-extinction: extinction",
                [&] { PreparedScene scene(request); });
}

TEST(ExtinctionLimit, ReflectanceEqualsChandrasekharsValue) {
  const TemporaryFolder folder;
  writeFile(folder / "v.nrrd", std::vector<std::uint8_t>(64, 10), cube);
  const auto transferFile = folder.write("at.json", makeDenseTransfer(1e6));
  RenderRequest request;
  request.input = folder / "v.nrrd";
  request.transfer = transferFile;
  request.lights = folder.write("lights.json", R"({"lights": [{"type": "environment",
                                                    "radiance": [1, 1, 1]}]})");
  request.view.scale = 1.5; // inside the silhouette, seen head-on
  const Estimate estimate = estimateMean(renderFilm(request, 250));
  EXPECT_NEAR(estimate.mean, 0.4149, 4.0 * estimate.error + 5e-5);
  EXPECT_LT(estimate.error, relaxError(0.005));
}

} // namespace
} // namespace fenestra::core::testing::VoxelStressTests
