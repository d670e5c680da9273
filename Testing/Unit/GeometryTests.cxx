// Each format places a phantom of eight corner points, in all orientations. DicomGeometryTests.cxx
// has the readers of DICOM.

#include "MedicalFiles.h"
#include "NiftiKinds.h"
#include "Orientations.h"

#include "files/medical/VolumeReader.h"

namespace fenestra::core::GeometryTests {
namespace {

using Path = std::filesystem::path;

constexpr int corners = 8;

/// 3 x 4 x 5 voxels, of which the corners have the values 1 to 8.
struct Phantom {
  NiftiFile file;
  Affine map; ///< index to RAS

  explicit Phantom(const Mat3& axes)
      : map(axes * Mat3::Diagonal(Vec3(0.75, 1.25, 2.5)), Vec3(31, -47, 102.5)) {
    file.size = {3, 4, 5};
    file.samples.assign(60, 0);
    for (int corner = 0; corner < corners; ++corner)
      file.samples[indexOf(corner)] = static_cast<std::int16_t>(corner + 1);
    file.setSform(map);
    file.setQform(map);
  }

  static Vec3 voxelOf(int corner) {
    return {2.0 * (corner & 1), 3.0 * (corner >> 1 & 1), 4.0 * (corner >> 2)};
  }
  static std::size_t indexOf(int corner) {
    const Vec3 voxel = voxelOf(corner);
    return static_cast<std::size_t>(voxel.x() + 3.0 * (voxel.y() + 4.0 * voxel.z()));
  }
  std::string samples() const { return rawBytes(file.samples); }
};

void expectPlaced(const Volume& volume, const Phantom& phantom, std::size_t warnings = 0) {
  EXPECT_EQ(volume.warnings.size(), warnings);
  expectCorners(volume, [&](int corner) { return phantom.map * Phantom::voxelOf(corner); });
}

/// Three numbers with enough digits, separated and enclosed as the format requires.
std::string format(const Vec3& v, const char* pattern) {
  char text[128];
  std::snprintf(text, sizeof text, pattern, v.x(), v.y(), v.z());
  return text;
}

std::string makeNrrd(const Phantom& phantom, const std::string& space) {
  const bool isLps = space == "left-posterior-superior";
  const auto place = [&](const Vec3& v) {
    return format(isLps ? lpsToRas * v : v, "(%.17g,%.17g,%.17g)");
  };
  const Mat3& steps = phantom.map.linear();
  return concat("NRRD0004\ntype: short\ndimension: 3\nspace: ", space,
                "\nsizes: 3 4 5\nspace directions: ", place(steps.col(0)), " ", place(steps.col(1)),
                " ", place(steps.col(2)),
                "\nendian: little\nencoding: raw\nspace origin: ", place(phantom.map.translation()),
                "\n\n", phantom.samples());
}

std::string makeMetaImage(const Phantom& phantom) {
  const auto place = [](const Vec3& v) { return format(lpsToRas * v, " %.17g %.17g %.17g"); };
  const Mat3 axes = phantom.map.linear().normalizedColumns();
  return concat("ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
                "TransformMatrix =",
                place(axes.col(0)), place(axes.col(1)), place(axes.col(2)),
                "\nOffset =", place(phantom.map.translation()),
                "\nElementSpacing = 0.75 1.25 2.5\nDimSize = 3 4 5\nElementType = MET_SHORT\n"
                "ElementDataFile = LOCAL\n",
                phantom.samples());
}

TEST(Geometry, TextHeadersPlaceCornersInAllOrientations) {
  const TemporaryFolder folder;
  for (const auto& [name, axes] : listOrientations()) {
    SCOPED_TRACE(name);
    const Phantom phantom(axes);
    for (const char* space : {"left-posterior-superior", "right-anterior-superior"})
      expectPlaced(readVolume(folder.write("v.nrrd", makeNrrd(phantom, space))), phantom);
    expectPlaced(readVolume(folder.write("v.mha", makeMetaImage(phantom))), phantom);
  }
}

TEST(Geometry, NiftiFormsPlaceCornersInAllOrientations) {
  const TemporaryFolder folder;
  for (const auto& [name, axes] : listOrientations())
    for (const auto& [qform, sform] : {std::pair(1, 0), {0, 1}, {1, 1}}) {
      SCOPED_TRACE(concat(name, qform, sform));
      Phantom phantom(axes);
      phantom.file.qformCode = static_cast<std::int16_t>(qform);
      phantom.file.sformCode = static_cast<std::int16_t>(sform);
      expectPlaced(readVolume(folder.write("v.nii", phantom.file.bytes())), phantom);
    }
}

TEST(Geometry, OtherBinaryHeadersPlaceCornersInAllOrientations) {
  const TemporaryFolder folder;
  for (const auto& [name, axes] : listOrientations()) {
    SCOPED_TRACE(name);
    Phantom phantom(axes);
    phantom.file.sformCode = 1;
    for (const std::endian order : {std::endian::little, std::endian::big})
      expectPlaced(readVolume(folder.write("v.nii", makeNifti2(phantom.file, order))), phantom);
    expectPlaced(readVolume(folder.write("v.mgh", makeMgh(phantom.file, phantom.map))), phantom);
    const Pair pair = makePair(phantom.file, "ni1");
    folder.write("v.hdr", pair.header);
    folder.write("v.img", pair.samples);
    expectPlaced(readVolume(folder / "v.img"), phantom);
  }
}

TEST(Geometry, AnalyzeCornersAreCenteredTowardLeftAnteriorSuperior) {
  const TemporaryFolder folder;
  Phantom phantom(Mat3::Diagonal(Vec3(-1, 1, 1)));
  phantom.map.translation() = Vec3(0.75, -1.25 * 1.5, -2.5 * 2.0);
  const Pair pair = makePair(phantom.file, std::string(3, '\0'));
  folder.write("v.img", pair.samples);
  expectPlaced(readVolume(folder.write("v.hdr", pair.header)), phantom, 1);
}

} // namespace
} // namespace fenestra::core::GeometryTests
