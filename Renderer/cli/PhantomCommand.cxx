#include "cli/Commands.h"

#include "cli/CommandLine.h"
#include "cli/Stop.h"
#include "core/Error.h"
#include "io/PhantomWriter.h"
#include "phantom/Knee.h"

#include <cstdio>
#include <iostream>

namespace fenestra {
namespace {

constexpr const char* group = "Phantom";
constexpr Flag flags[] = {
    {"output", "DIR", group, "Folder for KIND.nrrd, KIND.seg.nrrd and KIND.vp.json [KIND]"},
    {"size", "WxHxD", group, "Voxels over the same field of view [300x344x120]"},
};

const CommandSyntax syntax = {
    "phantom",
    "Makes a synthetic subject: an image, its segments and a transfer function.",
    {{"KIND", "knee"}},
    flags,
};

KneeOptions kneeOptions(const FlagValues& values) {
  KneeOptions options;
  const auto size = values.text("size");
  if (!size)
    return options;
  long x = 0;
  long y = 0;
  long z = 0;
  char rest = 0;
  if (std::sscanf(size->c_str(), "%ldx%ldx%ld%c", &x, &y, &z, &rest) != 3)
    throw usageError("--size: expected WIDTHxHEIGHTxDEPTH in voxels, got '" + *size + "'");
  options.size = {x, y, z};
  return options;
}

} // namespace

int phantomCommand(int argc, char** argv, int first) {
  const std::optional<FlagValues> values = parseCommandLine(syntax, argc, argv, first);
  if (!values)
    return 0;
  const std::string kind = *values->text("KIND");
  if (kind != "knee")
    throw usageError("KIND: '" + kind + "' is unknown; use knee");
  const std::string folder = values->text("output").value_or(kind);
  std::atomic<bool> stopped = false;
  StopOnSignal stopOnSignal;
  const Phantom phantom = makeKneePhantom(kneeOptions(*values));
  stopOnSignal.setInstead(stopped); // the files belong together
  writePhantom(phantom, folder, kind);
  std::cout << folder << ": " << kind << ".nrrd, " << kind << ".seg.nrrd, " << kind << ".vp.json, "
            << phantom.segments.size() << " segments" << std::endl;
  return stopped ? stoppedStatus : 0;
}

} // namespace fenestra
