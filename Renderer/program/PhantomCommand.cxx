#include "program/Commands.h"

#include "base/Error.h"
#include "phantoms/PhantomWriter.h"
#include "phantoms/Phantoms.h"
#include "program/CommandLine.h"
#include "program/Messages.h"
#include "program/UsageError.h"

#include <cstdio>

namespace fenestra {
namespace {

constexpr const char* phantomGroup = "Phantom";
const Option phantomTable[] = {
    {{"output", 'o'},
     "DIR",
     phantomGroup,
     "Folder for KIND.mrml, KIND.mrb, KIND.nrrd and the other files [KIND]"},
    {"size", "WxHxD", phantomGroup,
     concat("Voxels over a fixed field of view; N for the cube [knee ", joinNumbers(kneeSize, "x"),
            ", foot ", joinNumbers(footSize, "x"), ", fetus ", joinNumbers(fetusSize, "x"),
            ", cube ", CubeOptions().size, "]"),
     ValueSpec{.least = 16, .greatest = 1024}}, // range of the cube's N
    {"edge", "MM", phantomGroup, "Edge length of the cube",
     ValueSpec::number(1e-3, 1e5).withDefault(toString(CubeOptions().edge))},
    {OptionNames("quiet", 'q'), "", phantomGroup, "Prints only warnings and errors"},
};

/// Size WxHxD in voxels; without --size: `standard`.
Size3 readGridSize(const OptionValues& values, const Size3& standard) {
  const auto text = values.text("size");
  if (!text)
    return standard;
  Size3 size;
  char rest = 0;
  if (std::sscanf(text->c_str(), "%ldx%ldx%ld%c", &size[0], &size[1], &size[2], &rest) != 3)
    throw usageError("--size: expected WIDTHxHEIGHTxDEPTH in voxels, got '" + *text + "'");
  return size;
}

Phantom makeCube(const OptionValues& values) {
  CubeOptions options;
  if (values.has("edge"))
    values.read("edge", options.edge);
  if (values.has("size"))
    values.read("size", options.size);
  return makeCubePhantom(options);
}

Phantom makePhantom(const std::string& kind, const OptionValues& values) {
  if (kind != "cube" && values.has("edge"))
    throw usageError("--edge: only for the cube; omit it, or use phantom cube");
  if (kind == "knee")
    return makeKneePhantom(readGridSize(values, kneeSize));
  if (kind == "foot")
    return makeFootPhantom(readGridSize(values, footSize));
  if (kind == "fetus")
    return makeFetusPhantom(readGridSize(values, fetusSize));
  if (kind == "cube")
    return makeCube(values);
  throw usageError("KIND: '" + kind + "' is unknown; use knee, foot, fetus or cube");
}

} // namespace

const CommandSyntax& phantomSyntax() {
  static const CommandSyntax syntax = {
      "phantom",
      "Creates a synthetic subject: image, segments, transfer function, and Slicer scenes of them.",
      {{"KIND",
        "knee (MR), foot (CT), fetus (ultrasound) or cube (the scalar is the z index)",
        {"knee", "foot", "fetus", "cube"}}},
      phantomTable,
      {},
      "Write a synthetic subject to try Fenestra with",
      "phantom knee",
  };
  return syntax;
}

int phantomCommand(int argc, char** argv, int first) {
  const std::optional<OptionValues> values = parseCommandLine(phantomSyntax(), argc, argv, first);
  if (!values)
    return 0;
  const std::string kind = *values->text("KIND");
  const std::string folder = values->text("output").value_or(kind);
  configureMachine(*values);
  const Phantom phantom = makePhantom(kind, *values);
  const std::vector<std::string> files = writePhantom(phantom, folder, kind);
  if (!values->has("quiet"))
    printLine(concat(folder, ": ", join(files, " "), ", ", phantom.segments.size(), " segments"));
  return 0;
}

} // namespace fenestra
