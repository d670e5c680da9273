#include "clip/mesh/FocusTriangles.h"
#include "clip/mesh/SurfaceWriter.h"
#include "program/CommandLine.h"
#include "program/Commands.h"
#include "program/ErrorAdvice.h"
#include "program/Messages.h"
#include "program/RenderSteps.h"
#include "program/UsageError.h"
#include "scene/PreparedScene.h"

#include <algorithm>
#include <array>

namespace fenestra::core {
namespace {

/// Options of render that the focus depends on, and those of the process.
constexpr std::array sharedNames = {"segmentation",    "labels", "focus",   "preset",     "margin",
                                    "label-smoothing", "volume", "frame",   "nifti-form", "spacing",
                                    "strict",          "table",  "threads", "progress",   "quiet"};

std::vector<Option> makeMeshTable() {
  std::vector<Option> rows = {
      {{"output", 'o'}, "FILE", "Output", "Mesh to write: .vtp, .ply or .stl"}};
  std::ranges::copy_if(renderSyntax.options, std::back_inserter(rows), [](const Option& option) {
    return std::ranges::find(sharedNames, option.name) != sharedNames.end();
  });
  return rows;
}

/// The same values for the syntax of render.
OptionValues toRenderValues(const OptionValues& values) {
  OptionValues given(renderSyntax.options);
  given.add("INPUT", *values.text("INPUT"));
  for (const char* name : sharedNames)
    for (const std::string& value : values.texts(name))
      given.add(name, value);
  return given;
}

} // namespace

// Built on first use, since renderSyntax is initialized in another source file.
const CommandSyntax& meshSyntax() {
  static const std::vector<Option> table = makeMeshTable();
  static const CommandSyntax syntax = {
      "mesh",
      "Writes the surface of the focus as triangles, RAS, mm: as smooth, and with the margin, as "
      "in an image.",
      renderSyntax.positionals,
      table,
      {},
      "Write the surface of segments as triangles",
      "mesh knee.mrml --focus FemoralCartilage -o cartilage.stl",
  };
  return syntax;
}

int meshCommand(int argc, char** argv, int first) {
  const std::optional<OptionValues> values = parseCommandLine(meshSyntax(), argc, argv, first);
  if (!values)
    return 0;
  configureMachine(*values);
  const std::optional<std::string> path = values->text("output");
  if (!path)
    throw usageError("--output: missing; name the mesh to write, such as focus.stl");
  const RenderJob job = makeRenderJob(toRenderValues(*values));
  Outputs outputs;
  for (const std::filesystem::path& input : job.options.inputs)
    registerInput(input);
  declareSurface(*path, outputs);
  const PreparedScene::Focus focus = PreparedScene::readFocus(job.options.scene, job.input);
  if (!focus.input->mask)
    throw usageError("--focus: missing; name the segments to write (fenestra inspect lists them)");
  outputs.checkInputs();
  const SurfaceMesh mesh = triangulate(*focus.input->mask, focus.volume);
  writeSurface(mesh, *path, outputs);
  outputs.commit();
  for (const std::string& warning : composeMessages(focus.warnings))
    printWarning(warning);
  if (!job.options.quiet)
    printLine(concat(*path, ": ", mesh.triangles.size(), " triangles"));
  return 0;
}

} // namespace fenestra::core
