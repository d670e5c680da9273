// Choice among frames and NIfTI forms.

#include "NiftiFile.h"
#include "Refusals.h"

#include "files/medical/VolumeReader.h"

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
