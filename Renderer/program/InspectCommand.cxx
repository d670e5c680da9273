#include "program/Commands.h"

#include "base/Error.h"
#include "io/InputRegistry.h"
#include "io/JsonNode.h"
#include "program/CommandLine.h"
#include "program/ErrorAdvice.h"
#include "program/InspectionText.h"
#include "program/MergedOptions.h"
#include "program/Messages.h"
#include "program/UsageError.h"

#include <algorithm>
#include <iostream>

namespace fenestra::core {
namespace {

constexpr const char* inspectGroup = "Inspect";
const Option inspectTable[] = {
    {"volume", "NAME", inspectGroup,
     "As for render: volume of a scene, or series of a DICOM folder"},
    {"frame", "N", inspectGroup, "As for render: time of a series or 4D file"},
    {"nifti-form", "auto|qform|sform", inspectGroup, "As for render: which places a NIfTI volume"},
    {"spacing", "X,Y,Z", inspectGroup, "As for render: of a stack of images, mm"},
    {{"segmentation", 's'},
     "FILE|NAME",
     inspectGroup,
     "As for render: a file, or a node of the scene"},
    {"labels", "FILE|NAME", inspectGroup, "As for render: names of label values"},
    {"progress", "KIND", inspectGroup, "Accepted as by render; inspect shows no progress",
     ValueSpec::choice({"auto", "bar", "xml", "none"})},
    {"json", "", inspectGroup,
     "Print one JSON document: volumes, segmentations, volumeRenderings, volumeProperties, rois, "
     "views, cameras, transforms, series, others; materials (the library); examples; render (what "
     "it would use), refused (why it would fail, else null), warnings, ignored; units mm, RAS, ml"},
};

/// Arguments of `merged` that were not given, hence come from the scene.
std::vector<std::string> listStoredArguments(const OptionValues& given,
                                             const OptionValues& merged) {
  std::vector<std::string> arguments = merged.arguments();
  std::erase_if(arguments, [before = given.arguments()](const std::string& argument) {
    return std::ranges::find(before, argument) != before.end();
  });
  return arguments;
}

} // namespace

const CommandSyntax& inspectSyntax() {
  static const CommandSyntax syntax = {
      "inspect",
      "Lists what an input contains, what a render would use, and what it would ignore and why.",
      {{"INPUT",
        "Slicer scene (.mrml .mrb), volume (.nrrd .nhdr .nii .nii.gz .hdr .mgz .mha "
        ".mhd .vti .tif), label map, segmentation (.seg.nrrd), or folder of masks, DICOM files, "
        "or TIFF or PNG slices"}},
      inspectTable,
      {},
      "List what an input contains and what a render would use",
      "inspect scene.mrb",
  };
  return syntax;
}

int inspectCommand(int argc, char** argv, int first) {
  const std::optional<OptionValues> values = parseCommandLine(inspectSyntax(), argc, argv, first);
  if (!values)
    return 0;
  configureMachine(*values);
  const Input input(*values->text("INPUT"));
  OptionValues given(renderSyntax.options);
  for (const char* name :
       {"INPUT", "volume", "frame", "nifti-form", "spacing", "segmentation", "labels"})
    if (const auto value = values->text(name))
      given.add(name, *value);
  const SceneOptions stored = mergeSceneOptions(given, input);
  const OptionValues& merged = stored.values;
  RenderRequest request;
  request.input = input.path();
  request.volume = readVolumeChoice(merged);
  request.segmentation = merged.text("segmentation");
  request.labels = merged.text("labels");
  if (request.volume.name && !input.document() && !isDicomInput(input.path()))
    throw usageError("--volume: only for a scene or DICOM folder with several volumes; omit it");
  Inspection inspection = inspectInput(request, input);
  if (Inspection& use = inspection["render"]; !use.is_null())
    use["stored"] = listStoredArguments(given, merged);
  composeReport(inspection);
  const Inspection leftOut = stored.ignored;
  Inspection& warnings = inspection["warnings"];
  warnings.insert(warnings.begin(), leftOut.begin(), leftOut.end());
  allowClosedOutput();
  std::cout << (values->has("json") ? dumpJson(inspection) : formatInspection(inspection))
            << std::flush;
  return 0;
}

} // namespace fenestra::core
