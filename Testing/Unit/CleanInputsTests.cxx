// Inputs as scanners, archives and segmentation programs write them give no warning.

#include "scene/Input.h"

#include "DicomSliceFiles.h"
#include "NiftiKinds.h"
#include "SceneTesting.h"

#include <functional>

namespace fenestra::core::CleanInputsTests {
namespace {

using namespace dicomSlices;

using Path = std::filesystem::path;
using Warnings = std::vector<Message>;
using Write = std::function<Path(const TemporaryFolder&)>;

struct CleanInput {
  const char* name;
  Write write; ///< returns what the user names
};

// ---- volumes

const FileGeometry oblique{.directions = {{0.8, 0.6, 0}, {-0.6, 0.8, 0}, {0, 0, 1}},
                           .spacing = {0.7, 0.7, 1.5},
                           .origin = {-120.5, 33.25, 410}};

std::vector<std::int16_t> makeScan() {
  std::vector<std::int16_t> scalars(24);
  for (std::size_t i = 0; i < scalars.size(); ++i)
    scalars[i] = static_cast<std::int16_t>(100 * i - 1000);
  return scalars;
}

Write writeScan(const std::string& name, bool compress = false) {
  return [=](const TemporaryFolder& folder) {
    FileGeometry geometry = oblique;
    geometry.compress = compress;
    writeFile(folder / name, makeScan(), geometry);
    return folder / name;
  };
}

/// NIfTI-1 image whose forms agree but for the rounding of its numbers.
NiftiFile makeNifti(Affine& map) {
  NiftiFile file;
  map = Affine((makeRotation(0.4, Vec3(1, 2, 3).normalized())).linear() *
                   Mat3::Diagonal(Vec3(-0.7, 0.7, 1.5)),
               Vec3(121, -33, 410));
  file.samples = makeScan();
  file.setQform(map);
  file.setSform(map);
  file.qformCode = file.sformCode = 1;
  file.units = 10; // mm and s
  return file;
}

Path writeNifti(const TemporaryFolder& folder) {
  Affine map;
  return folder.write("v.nii", makeNifti(map).bytes());
}

Path writeNifti2(const TemporaryFolder& folder) {
  Affine map;
  return folder.write("v.nii", fenestra::core::makeNifti2(makeNifti(map), std::endian::little));
}

Path writePair(const TemporaryFolder& folder) {
  Affine map;
  const Pair pair = makePair(makeNifti(map), "ni1");
  folder.write("v.img", pair.samples);
  return folder.write("v.hdr", pair.header);
}

Path writeFreeSurfer(const TemporaryFolder& folder) {
  Affine map;
  const NiftiFile file = makeNifti(map);
  return folder.write("v.mgz", makeMgh(file, map));
}

/// Folder with the slices of a series from the last to the first, each with the same elements.
Write writeSeries(const std::vector<Element>& more) {
  return [=](const TemporaryFolder& folder) {
    constexpr int count = 9;
    for (int i = 0; i < count; ++i) {
      const double depth = std::round(1e3 * (i / 3.0)) / 1e3; // as scanners round it
      Slice slice{.value = 100.0 * i,
                  .position = Vec3(-120.5, -90.25, depth - 410),
                  .sopUid = concat("1.2.3.", i),
                  .instance = count - i};
      slice.more = merge(more, {makeText(0x00200052, "UI", "1.2.9")});
      folder.write(concat("IM", count - i), makeSlice(slice));
    }
    return folder.path();
  };
}

const std::vector<Element> mr = {
    makeText(0x00080060, "CS", "MR"), makeText(0x00080008, "CS", "ORIGINAL\\PRIMARY\\M\\SE"),
    makeDecimals(0x00180081, std::vector{92.0}), makeDecimals(0x00281052, std::vector{0.0}),
    makeDecimals(0x00281053, std::vector{1.0})};

std::vector<Element> makePet() {
  return {makeText(0x00080021, "DA", "20240301"),
          makeText(0x00080031, "TM", "110000.00"),
          makeText(0x00080060, "CS", "PT"),
          makeDecimals(0x00101030, std::vector{70.0}),
          makeDecimals(0x00281052, std::vector{0.0}),
          makeSequence(0x00540016, {{makeText(0x00181072, "TM", "100000"),
                                     makeDecimals(0x00181074, std::vector{3.5e8}),
                                     makeDecimals(0x00181075, std::vector{6586.2})}}),
          makeText(0x00541001, "CS", "BQML"),
          makeText(0x00541102, "CS", "START")};
}

Path writeEnhanced(const TemporaryFolder& folder) {
  return folder.write("enhanced.dcm",
                      makeFrames(9,
                                 [](unsigned i) { return Item{makePosition(Vec3(1, 2, 2.5 * i))}; },
                                 {makeShared(Mat3::Identity())}));
}

const std::vector<CleanInput> volumes = {
    {"raw NRRD", writeScan("v.nrrd")},
    {"compressed NRRD", writeScan("v.nrrd", true)},
    {"detached NRRD", writeScan("v.nhdr")},
    {"NIfTI", writeNifti},
    {"compressed NIfTI", writeScan("v.nii.gz")},
    {"NIfTI-2", writeNifti2},
    {"pair of NIfTI files", writePair},
    {"FreeSurfer", writeFreeSurfer},
    {"MetaImage", writeScan("v.mha")},
    {"compressed MetaImage of two files", writeScan("v.mhd", true)},
    {"CT", writeSeries({makeText(0x00080008, "CS", "ORIGINAL\\PRIMARY\\AXIAL")})},
    {"MR", writeSeries(mr)},
    {"PET", writeSeries(makePet())},
    {"enhanced CT", writeEnhanced},
};

// ---- segmentations of scans on the grid of `oblique`

Grid makeScanGrid() {
  Mat3 axes;
  for (int axis = 0; axis < 3; ++axis) {
    const auto& d = oblique.directions[static_cast<std::size_t>(axis)];
    axes.col(axis) = oblique.spacing[static_cast<std::size_t>(axis)] * Vec3(d[0], d[1], d[2]);
  }
  const Vec3 origin(oblique.origin[0], oblique.origin[1], oblique.origin[2]);
  return {Size3(3, 4, 2), Affine(lpsToRas * axes, lpsToRas * origin)};
}

std::vector<std::uint8_t> makeLabels() {
  std::vector<std::uint8_t> labels(24, 0);
  std::fill_n(labels.begin() + 3, 9, std::uint8_t{1});
  std::fill_n(labels.begin() + 14, 6, std::uint8_t{2});
  return labels;
}

Path writeSlicerSegments(const TemporaryFolder& folder) {
  FileGeometry geometry = oblique;
  geometry.compress = true;
  addSegment(geometry, 0, "Segment_1", "liver", "1", "0");
  addSegment(geometry, 1, "Segment_2", "tumor", "2", "0");
  writeFile(folder / "s.seg.nrrd", makeLabels(), geometry);
  return folder / "s.seg.nrrd";
}

/// A label map with a table of names beside it.
Write writeLabelMap(const std::string& name, const std::string& table, const std::string& text) {
  return [=](const TemporaryFolder& folder) {
    writeFile(folder / name, makeLabels(), oblique);
    folder.write(table, text);
    return folder / name;
  };
}

Path writeMasks(const TemporaryFolder& folder) {
  for (const std::uint8_t value : {std::uint8_t{1}, std::uint8_t{2}}) {
    auto mask = makeLabels();
    for (std::uint8_t& label : mask)
      label = label == value;
    writeFile(folder / (value == 1 ? "liver.nii.gz" : "spleen.nii.gz"), mask, oblique);
  }
  return folder.path();
}

Mat3 toAxes(const std::vector<std::vector<double>>& directions) {
  const auto column = [&](std::size_t i) {
    return Vec3(directions[i][0], directions[i][1], directions[i][2]);
  };
  return {column(0), column(1), column(2)};
}

/// As 3D Slicer and dcmqi write it: only frames with pixels, of several segments.
Path writeSeg(const TemporaryFolder& folder) {
  SegFile file{.columns = 3, .rows = 4, .axes = toAxes(oblique.directions)};
  file.origin = Vec3(-120.5, 33.25, 410);
  file.columnSpacing = file.rowSpacing = 0.7;
  file.step = file.statedStep = file.thickness = 1.5;
  file.segments = {{1, "liver", {30000, 40000, 35000}, "123037004", "10200004"}, {2, "tumor"}};
  file.frames = {{1, 0.0}, {1, 1.0}, {2, 1.0}};
  return folder.write("seg.dcm", makeSegFile(file));
}

Path writeStructures(const TemporaryFolder& folder) {
  const Mat3 axes = toAxes(oblique.directions);
  RoiFile roi{.name = "liver"};
  for (const double z : {0.0, 1.0})
    for (auto& contour = roi.contours.emplace_back();
         const auto& [x, y] : {std::pair(-0.3, 0.3), {2.2, 0.3}, {2.2, 3.1}, {-0.3, 3.1}})
      contour.push_back(Vec3(-120.5, 33.25, 410) + axes * Vec3(0.7 * x, 0.7 * y, 1.5 * z));
  const RoiFile point{
      .number = 2, .name = "isocenter", .contours = {{Vec3(-120.5, 33.25, 410)}}, .type = "POINT"};
  return folder.write("rt.dcm", makeStructureFile({roi, point}));
}

const std::vector<CleanInput> segmentations = {
    {"seg.nrrd", writeSlicerSegments},
    {"labels with a color table",
     writeLabelMap("l.nrrd", "l.ctbl", "1 liver 1 2 3 255\n2 tumor 4 5 6 255\n")},
    {"labels with a BIDS table",
     writeLabelMap("p_dseg.nii.gz", "p_dseg.tsv", "index\tname\n1\tliver\n2\ttumor\n")},
    {"folder of masks", writeMasks},
    {"SEG", writeSeg},
    {"RTSTRUCT", writeStructures},
};

Warnings collect(const std::vector<const Warnings*>& all) {
  Warnings together;
  for (const Warnings* one : all)
    together.insert(together.end(), one->begin(), one->end());
  return together;
}

void expectNone(const char* name, const Warnings& warnings) {
  for (const Message& warning : warnings)
    ADD_FAILURE() << name << ": " << warning.text();
}

TEST(CleanInputs, VolumesGiveNoWarning) {
  for (const CleanInput& input : volumes) {
    const TemporaryFolder folder;
    const Input opened(input.write(folder));
    expectNone(input.name, opened.volume(opened.chooseForm({}, std::nullopt))->volume.warnings);
    expectNone(input.name, opened.findUnusedSegmentations(std::nullopt));
  }
}

TEST(CleanInputs, SegmentationsGiveNoWarning) {
  for (const CleanInput& input : segmentations) {
    const TemporaryFolder folder, scans;
    const Path scan = writeScan("v.nrrd")(scans);
    const InputChoice choice{.segmentation = input.write(folder).string(), .focus = {"liver"}};
    const Input opened(scan);
    const Segmentation read = opened.segments(choice, makeScanGrid())->segmentation;
    expectNone(input.name, read.warnings());
    EXPECT_GT(read.makeFocusMask({"liver"}, makeScanGrid()).count, 0) << input.name;
  }
}

TEST(CleanInputs, ScenesAndArchivesGiveNoWarning) {
  const SceneFolder folder;
  FileGeometry geometry{.spacing = {1, 2, 3}, .origin = {10, 20, 30}};
  addSegment(geometry, 0, "Segment_1", "liver", "1", "0");
  writeFile(folder / "s.seg.nrrd", makeLabels(), geometry);
  const std::string nodes = volumeNode + R"(
    <SegmentationStorage id="ss" fileName="s.seg.nrrd"/>
    <Segmentation id="seg" name="S" references="storage:ss;"/>
    <VolumeProperty id="p" name="P" scalarOpacity="4 0 0 200 1" colorTransfer="8 0 1 1 1 200 1 1 1"/>)";
  const Path scene = folder.writeScene(nodes), archive = folder / "a.mrb";
  writeArchive(archive, {{"a/a.mrml", readBytes(scene)},
                         {"a/ct.nrrd", readBytes(folder / "ct.nrrd")},
                         {"a/s.seg.nrrd", readBytes(folder / "s.seg.nrrd")}});
  for (const Path& path : {scene, archive}) {
    const Input opened(path);
    const Volume volume = opened.volume({})->volume;
    const SceneSettings settings = opened.settings({}, true);
    const Segmentation read = opened.segments({.focus = {"liver"}}, volume.grid)->segmentation;
    expectNone(path.c_str(), collect({&volume.warnings, &settings.warnings, &read.warnings()}));
  }
}

} // namespace
} // namespace fenestra::core::CleanInputsTests
