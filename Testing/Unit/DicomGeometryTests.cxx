// DICOM images, SEG and RTSTRUCT place a phantom of eight corner points, in all orientations, as
// GeometryTests.cxx states for the other formats.

#include "DicomSliceFiles.h"
#include "Orientations.h"

#include "files/segments/SegmentationReader.h"

namespace fenestra::core::DicomGeometryTests {
namespace {

using namespace dicomSlices;

constexpr double tolerance = 1e-4; ///< mm
constexpr int columns = 5, rows = 4, slices = 6;
const Vec3 spacing(0.5, 2.0, 2.5);
const Vec3 origin(31, -47, 102.5); ///< LPS

/// Corner of the phantom, RAS. `axes`: LPS; the third one is that of the slices.
Vec3 locate(const Mat3& axes, int corner) {
  const Vec3 voxel((columns - 1) * (corner & 1), (rows - 1) * (corner >> 1 & 1),
                   (slices - 1) * (corner >> 2));
  return lpsToRas * (origin + axes * Vec3(voxel.array() * spacing.array()));
}

/// 16-bit pixels of a slice; those at its corners have the values 1 to 4, or 5 to 8 in the last.
Element makeSlicePixels(int slice) {
  std::vector<std::int16_t> pixels(columns * rows, 0);
  if (const int first = slice == 0 ? 1 : slice == slices - 1 ? 5 : 0; first > 0)
    for (int corner = 0; corner < 4; ++corner)
      pixels[static_cast<std::size_t>((columns - 1) * (corner & 1) +
                                      columns * (rows - 1) * (corner >> 1))] =
          static_cast<std::int16_t>(first + corner);
  return {0x7fe00010, "OW", rawBytes(pixels)};
}

void expectPlaced(const Volume& volume, const Mat3& axes) {
  EXPECT_TRUE(volume.warnings.empty());
  expectCorners(volume, [&](int corner) { return locate(axes, corner); });
}

const std::vector<Element> unscaled = {makeDecimals(0x00281052, std::vector{0.0}),
                                       makeDecimals(0x00281053, std::vector{1.0})};

TEST(DicomGeometry, SlicesPlaceCornersInAllOrientations) {
  for (const auto& [name, axes] : listOrientations()) {
    SCOPED_TRACE(name);
    const TemporaryFolder folder;
    for (int i = 0; i < slices; ++i) {
      Slice slice{.position = origin + axes.col(2) * (i * spacing.z()),
                  .instance = i,
                  .axes = axes,
                  .more = unscaled,
                  .columns = columns,
                  .rows = rows};
      slice.more.push_back(makeSlicePixels(i));
      slice.more.push_back(makeText(0x00080060, "CS", "MR"));
      folder.write(concat(7 * i % 10), makeSlice(slice)); // out of order
    }
    expectPlaced(read(folder.path()), axes);
  }
}

TEST(DicomGeometry, FramesPlaceCornersInAllOrientations) {
  for (const auto& [name, axes] : listOrientations()) {
    SCOPED_TRACE(name);
    const TemporaryFolder folder;
    Element pixels{0x7fe00010, "OW"};
    for (int i = 0; i < slices; ++i)
      pixels.value += makeSlicePixels(i).value;
    const auto groups = [&, slice = axes.col(2)](unsigned i) {
      return Item{makePosition(origin + slice * (i * spacing.z()))};
    };
    Element shared = makeShared(axes);
    shared.items[0].pop_back(); // rescaling
    folder.write("v", makeFrames(slices, groups,
                                 {makeText(0x00080060, "CS", "MR"), makeShorts(0x00280010, {rows}),
                                  makeShorts(0x00280011, {columns}), shared, pixels}));
    expectPlaced(read(folder.path()), axes);
  }
}

/// The voxels of the first segment are exactly those at the corners.
void expectPlaced(const Segmentation& segmentation, const Mat3& axes) {
  EXPECT_TRUE(segmentation.warnings().empty());
  const Mask mask = segmentation.makeMask({segmentation.segments()[0]}, segmentation.grid());
  EXPECT_EQ(mask.count, 8);
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 index = mask.grid.worldToIndex * locate(axes, corner);
    const Vec3 nearest = index.array().round();
    EXPECT_LT((mask.grid.indexToWorld.linear() * (index - nearest)).norm(), tolerance);
    EXPECT_TRUE(mask.contains(nearest.cast<std::int64_t>()));
  }
}

TEST(DicomGeometry, SegPlacesCornersInAllOrientations) {
  const TemporaryFolder folder;
  for (const auto& [name, axes] : listOrientations()) {
    SCOPED_TRACE(name);
    SegFile file{.columns = columns, .rows = rows, .axes = axes, .origin = origin};
    file.columnSpacing = spacing.x();
    file.rowSpacing = spacing.y();
    file.step = file.statedStep = spacing.z();
    for (const int slice : {slices - 1, 0})
      file.frames.push_back({1, double(slice), [](int x, int y) {
                               return x % (columns - 1) == 0 && y % (rows - 1) == 0 ? 1U : 0U;
                             }});
    expectPlaced(readSegmentation(folder.write("s.dcm", makeSegFile(file))), axes);
  }
}

TEST(DicomGeometry, StructuresPlaceCornersInAllOrientations) {
  const TemporaryFolder folder;
  for (const auto& [name, axes] : listOrientations()) {
    SCOPED_TRACE(name);
    const Grid volume(Size3(columns, rows, slices),
                      Affine(lpsToRas * axes * Mat3::Diagonal(spacing), lpsToRas * origin));
    RoiFile roi, body{.number = 2, .name = "body"};
    for (int corner = 0; corner < 8; ++corner) { // a rectangle around one voxel
      std::vector<Vec3>& contour = roi.contours.emplace_back();
      for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
        contour.push_back(lpsToRas * locate(axes, corner) +
                          axes * Vec3(0.3 * x * spacing.x(), 0.3 * y * spacing.y(), 0.0));
    }
    for (int slice = 0; slice < slices; ++slice) { // shows that slices between corners are empty
      const Vec3 first = origin + axes.col(2) * (slice * spacing.z());
      const Vec3 row = axes.col(0) * ((columns - 1) * spacing.x()),
                 column = axes.col(1) * ((rows - 1) * spacing.y());
      body.contours.push_back({first, first + row, first + row + column, first + column});
    }
    const Path path = folder.write("s.dcm", makeStructureFile({roi, body}));
    expectPlaced(readSegmentation(path, &volume), axes);
  }
}

} // namespace
} // namespace fenestra::core::DicomGeometryTests
