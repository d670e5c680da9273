#include "program/Commands.h"

#include "base/Error.h"
#include "base/safe/Inputs.h"
#include "program/CommandLine.h"
#include "program/InspectText.h"
#include "program/Machine.h"
#include "program/MergedFlags.h"

#include <algorithm>
#include <iostream>

namespace fenestra {
namespace {

constexpr const char* inspectGroup = "Inspect";
const Flag inspectFlags[] = {
    {"volume", "NAME", inspectGroup,
     "As for render: which volume of a scene, or series of a folder"},
    {"segmentation", "FILE|NAME", inspectGroup, "As for render: a file, or a node of the scene"},
    {"json", "", inspectGroup,
     "Print one JSON document: volumes, segmentations, volumeRenderings, volumeProperties, rois, "
     "views, cameras, transforms, series, others; render (what it would use), refused (why it "
     "would not start, else null), warnings, ignored; mm, RAS, ml"},
};

const CommandSyntax inspectSyntax = {
    "inspect",
    "Lists what an input holds, what a render of it would use, and what it would ignore and why.",
    {{"INPUT", "Slicer scene (.mrml .mrb), volume (.nrrd .nhdr .nii .nii.gz .mha .mhd), label map, "
               "segmentation (.seg.nrrd) or DICOM folder"}},
    inspectFlags,
};

/// Arguments of `merged` that are not given.
std::vector<std::string> argumentsBeyond(const FlagValues& given, const FlagValues& merged) {
  std::vector<std::string> arguments = merged.arguments();
  std::erase_if(arguments, [before = given.arguments()](const std::string& argument) {
    return std::ranges::find(before, argument) != before.end();
  });
  return arguments;
}

} // namespace

int inspectCommand(int argc, char** argv, int first) {
  const std::optional<FlagValues> values = parseCommandLine(inspectSyntax, argc, argv, first);
  if (!values)
    return 0;
  useMachine(*values);
  const Input input(*values->text("INPUT"));
  FlagValues given(renderSyntax.flags);
  for (const char* name : {"INPUT", "volume", "segmentation"})
    if (const auto value = values->text(name))
      given.add(name, *value);
  const SceneFlags stored = withSceneFlags(given, input);
  const FlagValues& flags = stored.flags;
  SceneRequest request;
  request.input = input.path();
  request.volume = flags.text("volume");
  request.segmentation = flags.text("segmentation");
  if (request.volume && !input.document() && !isFolder(input.path()))
    throw usageError("--volume: only a scene or a DICOM folder holds several; drop it");
  Inspection inspection = inspectInput(request, input);
  if (Inspection& use = inspection["render"]; !use.is_null())
    use["stored"] = argumentsBeyond(given, flags);
  const Inspection leftOut = stored.leftOut;
  Inspection& warnings = inspection["warnings"];
  warnings.insert(warnings.begin(), leftOut.begin(), leftOut.end());
  std::cout << (values->has("json")
                    ? inspection.dump(2, ' ', false, Inspection::error_handler_t::replace) + "\n"
                    : inspectionText(inspection))
            << std::flush;
  return 0;
}

} // namespace fenestra
