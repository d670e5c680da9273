// Images of one phantom must agree within their errors for every order and sign of NIfTI axes.

#include "Unit/NiftiFile.h"

#include "Agreement.h"
#include "RunSettings.h"
#include "TemporaryFolder.h"
#include "scene/FilmImage.h"
#include "scene/PreparedScene.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace fenestra::core::testing::NiftiOrderTests {
namespace {

const Size3 size(10, 12, 14);
const Vec3 spacing(1.2, 1.0, 0.8), origin(-20.0, 30.0, 5.0);

/// Ellipsoid cut by an oblique plane: any other order of axes changes it.
std::int16_t computeValue(const Size3& voxel) {
  const Vec3 at = (voxel.cast<double>().array() + 0.5) / size.cast<double>().array() - 0.5;
  return at.norm() < 0.48 && at.dot(Vec3(1.0, 0.6, 0.3)) < 0.12 ? 300 : -1000;
}

Image renderFile(const std::filesystem::path& file, std::uint64_t seed) {
  RenderRequest request;
  request.input = file;
  request.transfer = "ct-soft";
  request.lights = "cinema"; // small lamps make samples too skewed for their standard errors
  request.view.position = Vec3(60.0, 110.0, 70.0); // shows all three axes and the cut
  request.width = request.height = 24;
  const PreparedScene scene(request);
  RenderSettings settings;
  settings.samples = scaleSamples(std::uint64_t{256});
  settings.seed = shiftSeed(seed);
  RenderMonitor monitor;
  const Film film = render(scene.view(), settings, monitor).film;
  return makeImage(film, scene.camera(), scene.clip(), parseLayers({}));
}

TEST(NiftiOrder, EveryOrderAndSignOfAxesRendersTheSameImage) {
  const TemporaryFolder folder;
  Affine map;
  NiftiFile unpermuted = makeReordered(size, spacing, origin, computeValue, {0, 1, 2}, 0, map);
  unpermuted.setSform(map);
  unpermuted.sformCode = 1;
  const Image expected = renderFile(folder.write("whole.nii", unpermuted.bytes()), 1000);
  const std::pair<int, int> codes[] = {{0, 2}, {1, 0}, {1, 1}, {1, 2}}; // of qform and sform
  int number = 0, compared = 0;
  std::array<int, 3> order = {0, 1, 2};
  do {
    for (int reversed = 0; reversed < 8; ++reversed)
      for (const auto& [qform, sform] : codes) {
        // The short run tests each order and each sign once, and each pair of codes twelve times.
        if (!isLongRun() && number++ % 4 != reversed % 4)
          continue;
        NiftiFile file = makeReordered(size, spacing, origin, computeValue, order, reversed, map);
        file.setQform(map);
        file.setSform(map);
        if (qform == 1 && sform == 2) // a qform beside an sform is not used
          file.quaternionOffset[0] += 99.0F;
        file.qformCode = static_cast<std::int16_t>(qform);
        file.sformCode = static_cast<std::int16_t>(sform);
        const Image image =
            renderFile(folder.write("v.nii", file.bytes()), std::uint64_t(++compared));
        EXPECT_GT(computeAgreement(image, expected), 1e-3 / 192.0) // of up to 192 files
            << order[0] << order[1] << order[2] << " reversed " << reversed << " codes " << qform
            << sform;
      }
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_EQ(compared, isLongRun() ? 192 : 48);
}

} // namespace
} // namespace fenestra::core::testing::NiftiOrderTests
