// Expected result for every file in the folder of real data: an image, or a specific error. Skipped
// if the folder is missing.

#include "CommandTesting.h"

namespace fenestra::core::DataCommandTests {
namespace {

const std::filesystem::path data = FENESTRA_DATA;

/// Command line for real files ("@" is their folder). An empty `refusal` expects an image, any
/// other an error that contains it.
struct Expectation {
  std::string files; ///< tested files, separated by blanks; a trailing * is a wildcard
  std::string arguments;
  std::string refusal = {};
};

const std::vector<Expectation>& expectations() {
  static const std::string chest = "@/slicerio_segnrrd/CTChest4.nrrd ";
  static const std::string dose = "@/slicer_scenes/slicerrt_scenes/EclipseProstate_Dose.nrrd ";
  static const std::string tiny = "@/slicer_scenes/slicerrt_scenes/TinyPatientCT.nrrd ";
  static const std::vector<Expectation> table = {
      // volumes and label maps
      {"torso_ct_ccth_a01/ct.nii.gz torso_ct_ccth_a01/seg_totalsegmentator_rtstruct.nii.gz",
       "@/torso_ct_ccth_a01/ct.nii.gz --segmentation "
       "@/torso_ct_ccth_a01/seg_totalsegmentator_rtstruct.nii.gz --focus 1"},
      {"torso_ct_ccth_a01/seg_bone_200HU.nii.gz",
       "@/torso_ct_ccth_a01/ct.nii.gz --segmentation @/torso_ct_ccth_a01/seg_bone_200HU.nii.gz "
       "--focus 1"},
      {"torso_ct_ccth_a01/seg_labels.json",
       chest + "--transfer @/torso_ct_ccth_a01/seg_labels.json", "seg_labels.json:"},
      {"abdomen_ct_totalseg/ct.nii.gz abdomen_ct_totalseg/seg_multiorgan.nii.gz",
       "@/abdomen_ct_totalseg/ct.nii.gz --segmentation "
       "@/abdomen_ct_totalseg/seg_multiorgan.nii.gz --focus 20"},
      {"abdomen_ct_totalseg/seg_labels.json",
       chest + "--transfer @/abdomen_ct_totalseg/seg_labels.json", "seg_labels.json:"},
      {"head_mr_seg3d/t1.nii.gz head_mr_seg3d/seg_brain_skull.nii.gz",
       "@/head_mr_seg3d/t1.nii.gz --segmentation @/head_mr_seg3d/seg_brain_skull.nii.gz --focus 1"},
      {"head_mr_seg3d/original_Brain.nrrd",
       "@/head_mr_seg3d/t1.nii.gz --segmentation @/head_mr_seg3d/original_Brain.nrrd --focus 1"},
      {"head_mr_seg3d/original_BrainSkull.nrrd",
       "@/head_mr_seg3d/t1.nii.gz --segmentation @/head_mr_seg3d/original_BrainSkull.nrrd --focus "
       "1"},
      {"head_mr_seg3d/original_Skull.nrrd",
       "@/head_mr_seg3d/t1.nii.gz --segmentation @/head_mr_seg3d/original_Skull.nrrd --focus 1"},
      {"head_ct_slicer_dicom/ct_hu.nii.gz head_ct_slicer_dicom/seg_bone_200HU.nii.gz",
       "@/head_ct_slicer_dicom/ct_hu.nii.gz --segmentation "
       "@/head_ct_slicer_dicom/seg_bone_200HU.nii.gz --focus 1"},
      {"head_ct_slicer_dicom/dicom/*", "@/head_ct_slicer_dicom/dicom --segmentation "
                                       "@/head_ct_slicer_dicom/seg_bone_200HU.nii.gz --focus 1"},
      {"spl_knee_atlas_labels/SYNTHETIC_mr_256.nii.gz spl_knee_atlas_labels/seg_256.nii.gz",
       "@/spl_knee_atlas_labels/SYNTHETIC_mr_256.nii.gz --segmentation "
       "@/spl_knee_atlas_labels/seg_256.nii.gz --focus 83"},
      {"spl_knee_atlas_labels/seg.nrrd",
       "@/spl_knee_atlas_labels/SYNTHETIC_mr_256.nii.gz --segmentation "
       "@/spl_knee_atlas_labels/seg.nrrd --focus 83"},
      {"spl_knee_atlas_labels/knee.ctbl", "@/spl_knee_atlas_labels/knee.ctbl", "knee.ctbl:"},
      // segmentations written by Slicer
      {"slicerio_segnrrd/CTChest4.nrrd slicerio_segnrrd/Segmentation.seg.nrrd",
       chest + "--segmentation @/slicerio_segnrrd/Segmentation.seg.nrrd --focus ribs"},
      {"slicerio_segnrrd/SegmentationOverlapping.seg.nrrd",
       chest + "--segmentation @/slicerio_segnrrd/SegmentationOverlapping.seg.nrrd --focus ribs"},
      {"slicer_scenes/slicerrt_scenes/EclipseProstate_Dose.nrrd "
       "slicer_scenes/slicerrt_scenes/EclipseProstate_Bladder_Union_PTV.seg.nrrd",
       dose + "--segmentation "
              "@/slicer_scenes/slicerrt_scenes/EclipseProstate_Bladder_Union_PTV.seg.nrrd "
              "--focus Bladder_Union_PTV"},
      {"slicer_scenes/slicerrt_scenes/EclipseProstate_Expanded_5_5_5_Bladder.seg.nrrd",
       dose + "--segmentation "
              "@/slicer_scenes/slicerrt_scenes/EclipseProstate_Expanded_5_5_5_Bladder.seg.nrrd "
              "--focus Expanded_5_5_5_Bladder"},
      {"slicer_scenes/slicerrt_scenes/EclipseProstate_Structures.seg.vtm "
       "slicer_scenes/slicerrt_scenes/EclipseProstate_Structures.seg/*",
       dose + "--segmentation @/slicer_scenes/slicerrt_scenes/EclipseProstate_Structures.seg.vtm "
              "--focus Bladder",
       "is planar contours, not a closed surface"},
      {"slicer_scenes/slicerrt_scenes/TinyPatientCT.nrrd "
       "slicer_scenes/slicerrt_scenes/TinyPatientStructureSet.seg.vtm "
       "slicer_scenes/slicerrt_scenes/TinyPatientStructureSet.seg/*",
       tiny + "--segmentation @/slicer_scenes/slicerrt_scenes/TinyPatientStructureSet.seg.vtm "
              "--focus Tumor_Contour",
       "is planar contours, not a closed surface"},
      {"slicer_scenes/slicerrt_scenes/TinyPatientDose.nrrd",
       "@/slicer_scenes/slicerrt_scenes/TinyPatientDose.nrrd"},
      {"slicer_scenes/slicerrt_scenes/EclipseProstate_Structures_ColorTable.ctbl",
       "@/slicer_scenes/slicerrt_scenes/EclipseProstate_Structures_ColorTable.ctbl",
       "has an unknown extension"},
      {"torso_pet_ccth_a01/pet_suv.nii.gz", "@/torso_pet_ccth_a01/pet_suv.nii.gz"},
      {"aorta_dissection_totalseg/ct_cropped.nii.gz aorta_dissection_totalseg/labels.nii.gz "
       "aorta_dissection_totalseg/labels.ctbl",
       "@/aorta_dissection_totalseg/ct_cropped.nii.gz --segmentation "
       "@/aorta_dissection_totalseg/labels.nii.gz --labels "
       "@/aorta_dissection_totalseg/labels.ctbl --focus aorta_true_lumen"},
      // Inputs of public bug reports. Most are not supported yet; each README states its result.
      {"field/*", "@/field/ct.nii.gz --segmentation @/field/labels.nii.gz --focus 1"},
      {"head_stroke/stroke_T1.nii.gz", "@/head_stroke/stroke_T1.nii.gz"},
      {"head_stroke/stroke_T2.nii.gz", "@/head_stroke/stroke_T2.nii.gz"},
      {"head_stroke/stroke_FLAIR.nii.gz", "@/head_stroke/stroke_FLAIR.nii.gz"},
      // scenes
      {"slicer_scenes/slicer_5_2_written/chest.mrb",
       "@/slicer_scenes/slicer_5_2_written/chest.mrb --focus ribs"},
      {"slicer_scenes/slicer_5_2_written/chest_transformed_cropped.mrb",
       "@/slicer_scenes/slicer_5_2_written/chest_transformed_cropped.mrb --focus ribs"},
      {"slicer_scenes/slicerrt_scenes/Scenes/EclipseProstate_Dvh_Scene.mrml",
       "@/slicer_scenes/slicerrt_scenes/Scenes/EclipseProstate_Dvh_Scene.mrml"},
      {"slicer_scenes/slicerrt_scenes/Scenes/TinyPatient_ExternalBeamPlanning_Scene.mrml",
       "@/slicer_scenes/slicerrt_scenes/Scenes/TinyPatient_ExternalBeamPlanning_Scene.mrml "
       "--volume vtkMRMLScalarVolumeNode2"},
      {"slicer_scenes/slicer_core/vol_and_cube.mrml",
       "@/slicer_scenes/slicer_core/vol_and_cube.mrml", "fixed.nrrd: "},
      {"slicer_scenes/slicer_core/volRender.mrml", "@/slicer_scenes/slicer_core/volRender.mrml",
       "volRender.mrml:"},
      {"slicer_scenes/slicer_core/restoreSceneSnapshotCompareView.mrml",
       "@/slicer_scenes/slicer_core/restoreSceneSnapshotCompareView.mrml",
       "restoreSceneSnapshotCompareView.mrml:"},
      {"spl_knee_atlas_labels/KneeAtlas-2015Sept-Slicer4-4Version.mrml",
       "@/spl_knee_atlas_labels/KneeAtlas-2015Sept-Slicer4-4Version.mrml",
       "Slicer4-4Version.mrml: "},
      {"slicer_scenes/vr_properties/SM_presets.mrml",
       "@/slicer_scenes/vr_properties/SM_presets.mrml", "SM_presets.mrml:"},
      {"slicer_scenes/vr_properties/US-VrPresets.mrml",
       "@/slicer_scenes/vr_properties/US-VrPresets.mrml", "US-VrPresets.mrml:"},
      // transfer functions
      {"slicer_scenes/slicer_core/VolumeProperty.vp",
       chest + "--transfer @/slicer_scenes/slicer_core/VolumeProperty.vp"},
      {"slicer_scenes/vr_properties/FluoroRenderingPreset_01.vp",
       chest + "--transfer @/slicer_scenes/vr_properties/FluoroRenderingPreset_01.vp"},
      {"slicer_scenes/vr_properties/FluoroRenderingPreset_02.vp",
       chest + "--transfer @/slicer_scenes/vr_properties/FluoroRenderingPreset_02.vp"},
      {"slicer_scenes/vr_properties/FluoroRenderingPreset_03.vp",
       chest + "--transfer @/slicer_scenes/vr_properties/FluoroRenderingPreset_03.vp"},
      {"slicer_scenes/slicer_core/presets.xml", // a unit test reads its presets
       chest + "--transfer @/slicer_scenes/slicer_core/presets.xml", "presets.xml:"},
      {"slicer_scenes/slicer_core/volume-property-schema-v1.0.0.json",
       chest + "--transfer @/slicer_scenes/slicer_core/volume-property-schema-v1.0.0.json",
       "volume-property-schema-v1.0.0.json:"},
      {"slicer_scenes/slicer_core/AnnotationROI.acsv", // a unit test reads it as a region
       "@/slicer_scenes/slicer_core/AnnotationROI.acsv", "AnnotationROI.acsv:"},
  };
  return table;
}

std::vector<std::string> splitAtBlanks(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> all;
  for (std::string word; in >> word;)
    all.push_back(word);
  return all;
}

bool matches(const std::string& pattern, const std::string& file) {
  return pattern.ends_with('*') ? file.starts_with(pattern.substr(0, pattern.size() - 1))
                                : file == pattern;
}

TEST(RealData, EveryFileHasAnExpectation) {
  if (!std::filesystem::exists(data))
    GTEST_SKIP() << data << " does not exist";
  for (const std::string& file : listFiles(data)) {
    const std::string name = std::filesystem::path(file).filename().string();
    if (std::filesystem::is_directory(data / file) || name.starts_with("README") ||
        name.starts_with("LICENSE"))
      continue;
    bool known = false;
    for (const Expectation& expectation : expectations())
      for (const std::string& pattern : splitAtBlanks(expectation.files))
        known = known || matches(pattern, file);
    EXPECT_TRUE(known) << file << ": add its expected result to expectations()";
  }
}

class RealFiles : public ::testing::TestWithParam<Expectation> {};

TEST_P(RealFiles, RenderOrFailAsExpected) {
  if (!std::filesystem::exists(data))
    GTEST_SKIP() << data << " does not exist";
  const TemporaryFolder folder;
  Arguments arguments = splitAtBlanks(GetParam().arguments);
  for (std::string& argument : arguments)
    if (argument.starts_with('@'))
      argument.replace(0, 1, data.string());
  arguments.insert(arguments.end(), {"--size", "24x24", "--samples", "1", "--output", "p.exr"});
  const Outcome outcome = run(arguments, folder.path());
  if (GetParam().refusal.empty()) {
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(std::filesystem::exists(folder / "p.exr"));
    return;
  }
  EXPECT_EQ(outcome.status, 3);
  expectErrorLine(outcome.err, " | " + GetParam().refusal);
  EXPECT_TRUE(listFiles(folder.path()).empty());
}

INSTANTIATE_TEST_SUITE_P(All, RealFiles, ::testing::ValuesIn(expectations()),
                         [](const ::testing::TestParamInfo<Expectation>& info) {
                           std::string name = splitAtBlanks(info.param.files).back();
                           std::replace_if(
                               name.begin(), name.end(),
                               [](unsigned char c) { return !std::isalnum(c); }, '_');
                           return name;
                         });

} // namespace
} // namespace fenestra::core::DataCommandTests
