#include "program/Commands.h"

#include "base/Error.h"
#include "phantoms/PhantomWriter.h"
#include "phantoms/Phantoms.h"
#include "program/CommandLine.h"
#include "program/Messages.h"
#include "program/ProgressView.h"
#include "program/UsageError.h"

#include <cstdio>
#include <mutex>

namespace fenestra::core {
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

/// Progress line on a terminal, from construction to destruction.
class PhantomBar {
public:
  explicit PhantomBar(bool isQuiet)
      : m_view(isQuiet ? ProgressMode::none : ProgressMode::automatic, "Phantom") {}
  ~PhantomBar() { m_view.show(1.0, {}, true); }
  PhantomBar(const PhantomBar&) = delete;
  PhantomBar& operator=(const PhantomBar&) = delete;

  /// `fraction` of the voxels; from any thread.
  void showVoxels(double fraction) { show(voxelFraction * fraction, "voxels"); }
  void showWriting() { show(voxelFraction, "writing files"); }

private:
  static constexpr double voxelFraction = 0.9; ///< of the time; the files take the rest

  void show(double fraction, const char* step) {
    const std::lock_guard lock(m_mutex);
    m_view.show(fraction, {step}, false);
  }

  ProgressView m_view;
  std::mutex m_mutex;
};

Phantom makePhantom(const std::string& kind, const OptionValues& values,
                    const PhantomProgress& progress) {
  if (kind != "cube" && values.has("edge"))
    throw usageError("--edge: only for the cube; omit it, or use phantom cube");
  if (kind == "knee")
    return makeKneePhantom(readGridSize(values, kneeSize), progress);
  if (kind == "foot")
    return makeFootPhantom(readGridSize(values, footSize), progress);
  if (kind == "fetus")
    return makeFetusPhantom(readGridSize(values, fetusSize), progress);
  if (kind == "cube")
    return makeCube(values);
  throw usageError("KIND: '" + kind + "' is unknown; use knee, foot, fetus or cube");
}

/// Writes the files, and shows progress. Returns the files' names and the number of segments.
std::string createPhantom(const std::string& kind, const OptionValues& values,
                          const std::string& folder) {
  PhantomBar bar(values.has("quiet"));
  const Phantom phantom =
      makePhantom(kind, values, [&bar](double fraction) { bar.showVoxels(fraction); });
  bar.showWriting();
  const std::vector<std::string> files = writePhantom(phantom, folder, kind);
  return concat(join(files, " "), ", ", phantom.segments.size(), " segments");
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
  const Stopwatch watch;
  const std::string result = createPhantom(kind, *values, folder);
  if (!values->has("quiet"))
    printLine(concat(folder, ": ", result, ", ", toString(watch.seconds(), 3), " s"));
  return 0;
}

} // namespace fenestra::core
