// Wrong usage: exit status 2 and one line that names the option and the fix.

#include "CommandTesting.h"

#include <regex>
#include <unistd.h>

namespace fenestra::core::OptionsCommandTests {
namespace {

class OptionsCommand : public SmallScene {
protected:
  /// Usage error of `fenestra volume.nrrd …` with these options.
  static ExpectedError makeError(Arguments options, const std::string& text) {
    std::string name;
    for (const std::string& option : options)
      name += option + " ";
    options.insert(options.begin(), "volume.nrrd");
    return {name, options, 2, text};
  }
};

TEST_F(OptionsCommand, RejectsUnknownArgumentsAndSuggestsSimilarOnes) {
  expectErrors(
      {
          {"only render", {"render"}, 2, "INPUT: missing"},
          {"render misspelled", {"rendr", "volume.nrrd"}, 2, "'rendr': | fenestra render?"},
          {"compare misspelled", {"comprae", "a", "b"}, 2, "'comprae': | fenestra compare?"},
          {"two volumes", {"volume.nrrd", "other.nrrd"}, 2, "'other.nrrd': unexpected argument"},
          {"segmentation without -s",
           {"volume.nrrd", "segments.seg.nrrd"},
           2,
           "'segments.seg.nrrd': | -s "},
          {"image without -o", {"volume.nrrd", "new.nrrd"}, 2, "'new.nrrd': | -o "},
          {"version", {"version"}, 2, "'version': | fenestra --version?"},
          makeError({"--resolution", "8x8"}, "--resolution: | --size?"),
          makeError({"--sample", "3"}, "--sample: | --samples?"),
          makeError({"--smaples", "3"}, "--smaples: | --samples?"),
          makeError({"--Output=a.png"}, "--Output: | --output?"),
          makeError({"-output", "a.png"}, "-output: | --output?"),
          makeError({"--zzz"}, "--zzz: unknown option (see fenestra render --help"),
          makeError({"-x", "3"}, "-x: unknown option"),
          {"option of render", {"compare", "a", "b", "--seed", "1"}, 2, "--seed: unknown option"},
      },
      folder.path());
}

TEST_F(OptionsCommand, RejectsUnimplementedOptions) {
  std::vector<ExpectedError> refusals;
  refusals.push_back(makeError({"--resume", "1"}, "--resume: unknown option"));
  refusals.push_back(makeError(
      {"--segmentation", "segments.seg.nrrd", "--focus", "A", "--clip-boundary", "smooth"},
      "--clip-boundary: expected spline or exact, got 'smooth'"));
  expectErrors(refusals, folder.path());
}

TEST_F(OptionsCommand, RejectsMissingAndRepeatedValues) {
  expectErrors(
      {
          makeError({"--samples"}, "--samples: value is missing; write --samples N"),
          makeError({"--samples", "--seed", "3"}, "--samples: value is missing"),
          makeError({"--samples="}, "--samples: value is missing"),
          makeError({"--samples", ""}, "--samples: value is empty"),
          makeError({"--samples", "--help="}, "--samples: value is missing"),
          makeError({"--echo=1"}, "--echo: takes no value"),
          makeError({"--", "--echo"}, "'--echo': unexpected argument after INPUT"),
          makeError({"--samples", "3", "--samples", "4"}, "--samples: given more than once"),
      },
      folder.path());
}

TEST_F(OptionsCommand, RejectsNumbersOutOfRange) {
  std::vector<ExpectedError> refusals;
  const auto refuseAll = [&](const std::string& option, const Arguments& values) {
    for (const std::string& value : values)
      refusals.push_back(makeError({option, value}, option + ": "));
  };
  const Arguments noNumbers = {"nan", "inf", "-inf", "", "many", "1e999", "0x10", "1,5"};
  for (const char* option :
       {"--samples", "--seed", "--bounces", "--threads", "--control-points", "--seconds", "--noise",
        "--scale", "--spline-smoothing", "--transfer-shift", "--density-scale"})
    refuseAll(option, noNumbers);
  refuseAll("--samples", {"0", "-1", "1.5", "99999999999999999999"});
  refuseAll("--seed", {"-1", "18446744073709551616"});
  refuseAll("--bounces", {"-1", "0.5"});
  refuseAll("--threads", {"-1", "1025"});
  refuseAll("--control-points", {"2", "1001"});
  refuseAll("--seconds", {"0", "-1"});
  refuseAll("--noise", {"0", "-1"});
  refuseAll("--scale", {"0", "-1", "1e10"});
  refuseAll("--spline-smoothing", {"-0.1", "1.1"});
  refuseAll("--density-scale", {"-1", "1001"});
  for (const char* option : {"--position", "--target", "--up"})
    refuseAll(option, {"1,2", "1,2,3,4", "1,2,nan", "1,2,inf", "a,b,c", "1,,3", ""});
  refuseAll("--environment", {"1,2", "-1,0,0", "1,2,nan", "1e300,0,0", "sky.hdr"});
  refuseAll("--background", {"1,2", "0,0,-1", "1,2,nan", "blue"});
  refuseAll("--exposure", {"17", "-16.5", "nan", "1,2", "bright"});
  refuseAll("--annotate", {"ruler", "scale,ruler", "none,scale", "scale,", ""});
  refuseAll("--size", {"0x0", "32", "-1x3", "1x1x1", "1e3x2", "32X32", "16385x1", "1x16385",
                       "99999999999x1", "x", "nanxnan", ""});
  expectErrors(refusals, folder.path());
}

TEST_F(OptionsCommand, RejectsAnglesAndPlanesOutOfRange) {
  std::vector<ExpectedError> refusals;
  for (const char* angle : {"0", "180", "-30", "nan", "inf", "wide"})
    refusals.push_back(
        makeError({"--projection", "perspective", "--angle", angle}, "--angle: expected a number"));
  for (const char* plane : {"0,0,0", "0,0,0,0,0,0", "0,0,0,0,0,nan", "a"})
    refusals.push_back(makeError({"--clip", "plane", "--plane", plane}, "--plane: "));
  expectErrors(refusals, folder.path());
}

TEST_F(OptionsCommand, RejectsAnImageLargerThanMemory) {
  const double memory =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  if (memory > 60e9)
    GTEST_SKIP() << "this machine has enough memory for the largest image";
  expectErrors({{"largest", {"volume.nrrd", "--size", "16384x16384"}, 4, "size: | GB"}},
               folder.path());
}

TEST_F(OptionsCommand, RejectsUnknownWords) {
  expectErrors(
      {
          makeError({"--view", "top"}, "--view: expected anterior"),
          makeError({"--view", "auto"}, "--view: auto requires a focus; add --focus"),
          makeError({"--projection", "fisheye"},
                    "--projection: expected orthographic or perspective"),
          makeError({"--clip", "drill"},
                    "--clip: expected auto, none, plane, hole, cutaway, ghost or surface, got"),
          makeError({"--progress", "dots"}, "--progress: expected auto, bar, xml or none, got"),
          makeError({"--layers", "colors", "--output", "a.exr"}, "layers: | colors"),
      },
      folder.path());
}

TEST_F(OptionsCommand, RejectsContradictions) {
  const auto withFocus = [](Arguments options, const std::string& text) {
    const Arguments focus = {"--segmentation", "segments.seg.nrrd", "--focus", "A"};
    options.insert(options.begin(), focus.begin(), focus.end());
    return makeError(options, text);
  };
  expectErrors(
      {
          makeError({"--view", "left", "--position", "1,2,3"}, " | --view and --position"),
          makeError({"--plane", "0,0,0,0,0,1"}, "--plane: used only with --clip plane"),
          makeError({"--clip", "none", "--plane", "0,0,0,0,0,1"}, "--plane: used only with"),
          makeError({"--clip", "plane"}, "--clip: plane requires --plane OX,OY,OZ,NX,NY,NZ"),
          makeError({"--clip", "surface"}, "--clip: surface requires a focus; add --focus"),
          makeError({"--clip", "cutaway"}, "--clip: cutaway requires a focus; add --focus"),
          makeError({"--projection", "perspective", "--scale", "10"}, "--scale: only for"),
          makeError({"--angle", "20"}, "--angle: only for --projection perspective"),
          makeError({"--annotate", "orientation,scale", "--projection", "perspective", "--transfer",
                     "missing"}, // detected before inputs are read
                    "--annotate: scale requires an orthographic projection"),
          makeError({"--focus", "A"}, "--focus: requires --segmentation FILE"),
          makeError({"--segmentation", "segments.seg.nrrd"},
                    "--segmentation: used only with --focus, --materials or --preset"),
          withFocus({"--clip", "none", "--spline-smoothing", "1"},
                    "--spline-smoothing: used only with"),
          withFocus({"--clip", "cutaway", "--spline-smoothing", "1"},
                    "--spline-smoothing: used only with"),
          makeError({"--control-points", "9"},
                    "--control-points: used only with --clip surface and ghost"),
          makeError({"--clip", "hole"}, "--clip: hole requires a focus; add --focus"),
          makeError({"--clip", "ghost"}, "--clip: ghost requires a focus; add --focus"),
          withFocus({"--hole", "box"}, "--hole: used only with --clip hole; add that"),
          withFocus({"--hole-margin", "2"}, "--hole-margin: used only with --clip hole"),
          withFocus({"--clip", "hole", "--hole-margin", "-1"}, "--hole-margin: "),
          withFocus({"--clip", "hole", "--hole", "cone"}, "--hole: "),
          withFocus({"--ghost", "0.2"}, "--ghost: used only with --clip ghost"),
          withFocus({"--clip", "ghost", "--ghost", "1.5"}, "--ghost: "),
          withFocus({"--clip", "none", "--clip-offset", "2"},
                    "--clip-offset: has no effect without a clip"),
          withFocus({"--clip", "none", "--clip-softness", "2"},
                    "--clip-softness: has no effect without a clip"),
          makeError({"--margin", "2"}, "--margin: requires a focus; add --focus"),
          makeError({"--label-smoothing", "1"}, "--label-smoothing: requires a focus or materials"),
          makeError({"--context-density", "0.5"}, "--context-density: requires a focus"),
          makeError({"--context-saturation", "0.5"}, "--context-saturation: requires a focus"),
          withFocus({"--margin", "1,2,3"}, "margin: | 3 values"),
          withFocus({"--margin", "1,x"}, "--margin: "),
          withFocus({"--margin", "2000"}, "--margin: must be from -1000 to 1000 mm"),
          makeError({"--surface", "a.vtp"}, "--surface: not available with --clip none and plane"),
          withFocus({"--clip", "none", "--surface", "a.vtp"},
                    "--surface: not available with --clip none and plane"),
          withFocus({"--clip", "plane", "--plane", "0,0,0,0,0,1", "--surface", "a.vtp"},
                    "--surface: not available with --clip none and plane"),
          makeError({"--position", "1,2,3", "--target", "1,2,3"}, "camera:"),
          makeError({"--position", "0,0,9", "--target", "0,0,0", "--up", "0,0,1"}, "camera: | up"),
          makeError({"--up", "0,0,0"}, "camera: | up"),
          makeError({"--view", "superior", "--up", "0,0,1"}, "camera: | up"),
      },
      folder.path());
}

TEST_F(OptionsCommand, VersionIsTheFirstLineForEveryCommand) {
  for (const Arguments& arguments : {Arguments{"--version"},
                                     {"render", "--version"},
                                     {"compare", "--version"},
                                     {"phantom", "--version"}}) {
    const Outcome outcome = run(arguments, folder.path());
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    static const std::regex version("fenestra [0-9]+\\.[0-9]+\\.[0-9]+");
    EXPECT_TRUE(std::regex_match(outcome.out.substr(0, outcome.out.find('\n')), version))
        << outcome.out;
  }
}

} // namespace
} // namespace fenestra::core::OptionsCommandTests
