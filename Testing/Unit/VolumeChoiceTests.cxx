// Choice among frames and NIfTI forms.

#include "NiftiFile.h"
#include "Refusals.h"

#include "files/medical/NiftiForms.h"
#include "files/medical/VolumeReader.h"
#include "files/segments/SegmentationReader.h"

#include <gtest/gtest.h>

namespace fenestra::VolumeChoiceTests {
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

} // namespace
} // namespace fenestra::VolumeChoiceTests
