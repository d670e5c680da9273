// Requests that find the lungs of a CT, and requests that refuse what a reader assumed.

#include "scene/PreparedScene.h"

#include "MedicalFiles.h"
#include "Refusals.h"
#include "SyntheticChest.h"

namespace fenestra::core::LungSegmentTests {
namespace {

/// Files of a chest, and a request that shows its lungs.
class LungSegment : public ::testing::Test {
protected:
  LungSegment() {
    request.input = folder / "ct.nrrd";
    request.transfer = lungTransfer;
    request.width = request.height = 32;
  }

  void writeChest(const SyntheticChest& chest) const {
    const Volume ct = chest.volume();
    const auto& voxels = std::get<LargeArray<std::int16_t>>(ct.voxels);
    FileGeometry geometry;
    for (int axis = 0; axis < 3; ++axis)
      geometry.size[static_cast<std::size_t>(axis)] = static_cast<std::size_t>(ct.grid.size[axis]);
    geometry.spacing = {3, 3, 3};
    writeFile(folder / "ct.nrrd", std::vector<std::int16_t>(voxels.begin(), voxels.end()),
              geometry);
  }

  TemporaryFolder folder;
  RenderRequest request;
};

TEST_F(LungSegment, IsTheFocusOfItsTransferFunction) {
  writeChest({});
  const PreparedScene scene(request);
  ASSERT_TRUE(scene.focus());
  EXPECT_TRUE(std::holds_alternative<ClipDepth>(scene.clip()));
  EXPECT_EQ(scene.warnings(), std::vector<Message>());
  request.clip.mode = ClipMode::none;
  EXPECT_FALSE(scene.withRequest(request).focus());
  request.clip.mode.reset();
  request.transfer = "ct-skin";
  EXPECT_FALSE(scene.withRequest(request).focus());
}

TEST_F(LungSegment, IsMissingWithAWarning) {
  writeChest({.hasLungs = false});
  const PreparedScene scene(request);
  EXPECT_FALSE(scene.focus());
  ASSERT_EQ(scene.warnings().size(), 1U);
  EXPECT_EQ(scene.warnings()[0].code, ErrorCode::emptyFocus);
}

TEST(StrictRequest, RefusesAssumptions) {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& name, const std::string& space) {
    const std::string header = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\n"
                               "encoding: raw\n" +
                               space + "\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n\n";
    return folder.write(name, header + "\1\2\3\4\5\6\7\10");
  };
  RenderRequest request;
  request.width = request.height = 16;
  request.isStrict = true;
  request.input = write("stated.nrrd", "space: left-posterior-superior");
  EXPECT_EQ(PreparedScene(request).warnings(), std::vector<Message>());
  request.input = write("assumed.nrrd", "space dimension: 3");
  expectRefused(request.input, "assumed-geometry", [&] { PreparedScene scene(request); });
  request.isStrict = false;
  EXPECT_EQ(PreparedScene(request).warnings().size(), 1U);
}

} // namespace
} // namespace fenestra::core::LungSegmentTests
