// Choice among frames and NIfTI forms; spacing of files that state none.

#include "Approx.h"
#include "NiftiFile.h"
#include "Refusals.h"

#include "files/medical/NiftiForms.h"
#include "files/medical/VolumeReader.h"
#include "files/segments/SegmentationReader.h"

#include <gtest/gtest.h>

namespace fenestra::core::VolumeChoiceTests {
namespace {

TEST(VolumeChoice, FrameBeyondTheLastIsRefused) {
  const TemporaryFolder folder;
  NiftiFile file;
  file.sformCode = 1;
  const auto path = folder.write("v.nii", file.bytes());
  EXPECT_TRUE(readVolume(path, {.frame = 0}).warnings.empty());
  expectRefused(path, "unknown-frame | 1 frame", [&] { readVolume(path, {.frame = 1}); });
}

TEST(VolumeChoice, ChosenFrameGivesNoWarning) {
  std::vector<Message> warnings;
  EXPECT_EQ(chooseFrame("v", 2, 3, warnings), 2U);
  EXPECT_EQ(chooseFrame("v", {}, 1, warnings), 0U);
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(chooseFrame("v", {}, 3, warnings), 0U);
  ASSERT_EQ(warnings.size(), 1U);
  expectMessage(warnings[0], "assumed-frame | 3 frames");
}

TEST(VolumeChoice, ChosenFormPlacesTheVolumeWithoutWarning) {
  const TemporaryFolder folder;
  NiftiFile file;
  file.qformCode = file.sformCode = 1;
  file.setQform(makeTranslation({30.0, 0.0, 0.0}));
  const auto path = folder.write("v.nii", file.bytes());
  EXPECT_EQ(readVolume(path).warnings.size(), 1U);
  for (const auto& [form, x] : {std::pair(NiftiForm::qform, 30.0), {NiftiForm::sform, 0.0}}) {
    const Volume volume = readVolume(path, {.niftiForm = form});
    EXPECT_EQ(volume.grid.indexToWorld.translation()[0], x);
    EXPECT_TRUE(volume.warnings.empty());
  }
}

/// Volume whose qform is 30 mm beside its sform.
NiftiFile makeDisagreeing() {
  NiftiFile file;
  file.qformCode = file.sformCode = 1;
  file.samples[5] = 1;
  file.setQform(makeTranslation({30.0, 0.0, 0.0}));
  return file;
}

NiftiFile makePlaced(const Vec3& origin) {
  NiftiFile file;
  file.samples[5] = 1;
  file.sformCode = 1;
  file.setSform(makeTranslation(origin));
  return file;
}

TEST(VolumeChoice, GridOfTheOtherFileChoosesTheForm) {
  const TemporaryFolder folder;
  const auto path = folder.write("v.nii", makeDisagreeing().bytes());
  const auto choose = [&](const Vec3& origin) {
    VolumeChoice choice;
    const auto other = folder.write("s.nii", makePlaced(origin).bytes());
    chooseNiftiForm(
        path, [&] { return readPossibleGrids(other); }, "s.nii", choice);
    return choice;
  };
  EXPECT_EQ(choose({30.4, 0.0, 0.0}).niftiForm, NiftiForm::qform);
  EXPECT_EQ(choose({0.4, 0.0, 0.0}).niftiForm, NiftiForm::sform);
  EXPECT_FALSE(choose({30.6, 0.0, 0.0}).niftiForm);
  const Volume volume = readVolume(path, choose({30.0, 0.0, 0.0}));
  EXPECT_EQ(volume.grid.indexToWorld.translation()[0], 30.0);
  ASSERT_EQ(volume.warnings.size(), 1U);
  expectMessage(volume.warnings[0], "assumed-form | qform | s.nii | 30 mm");
}

TEST(VolumeChoice, BothFormsOfTheOtherFileAgreeSoNoneIsChosen) {
  const TemporaryFolder folder;
  const auto path = folder.write("v.nii", makeDisagreeing().bytes());
  VolumeChoice choice;
  chooseNiftiForm(
      path, [&] { return readPossibleGrids(path); }, "itself", choice);
  EXPECT_FALSE(choice.niftiForm);
}

TEST(VolumeChoice, LabelMapWithTwoFormsFollowsTheVolume) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "masks");
  const auto labels = folder.write("labels.nii", makeDisagreeing().bytes());
  folder.write("masks/organ.nii", makeDisagreeing().bytes());
  for (const double x : {0.0, 30.0}) {
    const Grid volume({3, 4, 2}, makeTranslation({x, 0.0, 0.0}));
    EXPECT_EQ(readSegmentation(labels, &volume).grid().indexToWorld.translation()[0], x);
    const Mask mask = readSegmentation(folder / "masks", &volume).makeFocusMask({"organ"}, volume);
    const Vec3 index = (mask.grid.worldToIndex * Vec3(x + 2.0, 1.0, 0.0)).array().round();
    ASSERT_TRUE((index.array() >= 0.0).all());
    EXPECT_GT(mask.voxels.at(linearIndex(index.cast<std::int64_t>(), mask.grid.size)), 0);
  }
}

TEST(VolumeChoice, MissingFormIsRefused) {
  const TemporaryFolder folder;
  NiftiFile file;
  file.sformCode = 1;
  const auto path = folder.write("v.nii", file.bytes());
  expectRefused(path, "unknown-form | qform",
                [&] { readVolume(path, {.niftiForm = NiftiForm::qform}); });
}

/// `space`: further fields of a NRRD, one per line.
std::string makeNrrd(const std::string& space) {
  return "NRRD0004\ntype: uint8\nencoding: raw\ndimension: 3\nsizes: 3 4 2\n" + space + "\n" +
         std::string(24, 'x');
}

std::string makeMeta(const std::string& spacing) {
  return "ObjectType = Image\nNDims = 3\nDimSize = 3 4 2\n" + spacing +
         "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n" + std::string(24, 'x');
}

TEST(VolumeChoice, SpacingReplacesTheAssumedOne) {
  const TemporaryFolder folder;
  const Vec3 spacing(0.5, 2.0, 3.0);
  const auto nrrd = folder.write("v.nrrd", makeNrrd("")),
             meta = folder.write("v.mha", makeMeta(""));
  for (const auto& [path, others] : {std::pair(nrrd, 1U), {meta, 0U}}) { // no space: axes assumed
    ASSERT_EQ(readVolume(path).warnings.size(), 1U) << path;
    EXPECT_NE(readVolume(path).warnings[0].detail.find("1 mm"), std::string::npos);
    const Volume volume = readVolume(path, {.spacing = spacing});
    EXPECT_TRUE(isApprox(volume.grid.indexToWorld * Vec3(2, 3, 1), Vec3(-1, -6, 3), 1e-12));
    ASSERT_EQ(volume.warnings.size(), others);
    for (const Message& warning : volume.warnings)
      EXPECT_EQ(warning.detail.find("1 mm"), std::string::npos);
  }
}

TEST(VolumeChoice, SpacingOfAFileThatStatesOneIsRefused) {
  const TemporaryFolder folder;
  NiftiFile file;
  file.sformCode = 1;
  for (const auto& path :
       {folder.write("s.nrrd", makeNrrd("spacings: 1 1 1\n")),
        folder.write("d.nrrd", makeNrrd("space: left-posterior-superior\n"
                                        "space directions: (1,0,0) (0,1,0) (0,0,1)\n")),
        folder.write("v.mha", makeMeta("ElementSpacing = 1 1 1\n")),
        folder.write("v.nii", file.bytes())})
    expectRefused(path, "invalid-value",
                  [&] { readVolume(path, {.spacing = Vec3(1.0, 1.0, 1.0)}); });
}

} // namespace
} // namespace fenestra::core::VolumeChoiceTests
