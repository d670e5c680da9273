#include "program/Commands.h"

#include "base/Error.h"
#include "files/images/ImageReader.h"
#include "files/images/ImageWriter.h"
#include "image/Compare.h"
#include "io/InputRegistry.h"
#include "program/CommandLine.h"
#include "program/Messages.h"

#include <cstdio>

namespace fenestra::core {
namespace {

constexpr const char* compareGroup = "Compare";
const Option compareTable[] = {
    {"error-a", "FILE", compareGroup, "Standard errors of A, if A itself has no error channels"},
    {"error-b", "FILE", compareGroup, "Standard errors of B, if B itself has no error channels"},
    {OptionNames("output", 'o'), "FILE", compareGroup, "Difference image: .png .tif .exr .nrrd"},
};

Image readWithError(const OptionValues& values, const char* name, const char* errorOption) {
  Image image = readImage(*values.text(name));
  if (const auto error = values.text(errorOption))
    attachError(image, readImage(*error));
  return image;
}

/// Throws Error before the images are read, not after.
void declareOutput(const OptionValues& values, Outputs& outputs) {
  for (const char* name : {"A", "B", "error-a", "error-b"})
    if (const auto input = values.text(name))
      registerInput(*input);
  if (const auto output = values.text("output"))
    declareImage(*output, outputs);
}

/// Adds the file names to errors, since compareImages only knows images.
Comparison compareFiles(const OptionValues& values, const Image& a, const Image& b) {
  try {
    return compareImages(a, b);
  } catch (const Error& error) {
    throw Error(error.kind(),
                makeMessage(error.message().code,
                            concat(*values.text("A"), ", ", *values.text("B")), error.what()));
  }
}

void print(const Comparison& c) {
  std::printf("relMSE      %.6g\n", c.relMse);
  std::printf("RMSE        %.6g\n", c.rmse);
  std::printf("PSNR        %.4g dB (peak 1)\n", c.psnr);
  std::printf("largest     %.6g\n", c.maxDifference);
  std::printf("mean A      %.6g %.6g %.6g\n", c.meanA[0], c.meanA[1], c.meanA[2]);
  std::printf("mean B      %.6g %.6g %.6g\n", c.meanB[0], c.meanB[1], c.meanB[2]);
  if (c.notFinite > 0)
    std::printf("not finite  %zu\n", c.notFinite);
  if (!c.z)
    return;
  const ZStatistics& z = *c.z;
  std::printf("z           mean %.4f, deviation %.4f, over %zu values\n", z.mean, z.deviation,
              z.count);
  std::printf("|z| > 3     %.4f %% (0.27 %% for normal noise)\n", 100.0 * z.fractionAbove3);
  std::printf("largest |z| %.3f at column %d, row %d, %c\n", z.largest, z.column, z.row, z.channel);
  std::printf("image mean  %.2f %.2f %.2f standard errors apart\n", z.imageMean[0], z.imageMean[1],
              z.imageMean[2]);
}

} // namespace

const CommandSyntax& compareSyntax() {
  static const CommandSyntax syntax = {
      "compare",
      "Compares image A with reference B: error measures, and statistics of z if both have "
      "standard errors.",
      {{"A", "Image: .exr .nrrd .png .tif"}, {"B", "Reference of the same size"}},
      compareTable,
      {},
      "Compare two images: error measures and statistics of z",
      "compare image.exr reference.exr -o difference.png",
  };
  return syntax;
}

int compareCommand(int argc, char** argv, int first) {
  const std::optional<OptionValues> values = parseCommandLine(compareSyntax(), argc, argv, first);
  if (!values)
    return 0;
  Outputs outputs;
  declareOutput(*values, outputs);
  const Image a = readWithError(*values, "A", "error-a");
  const Image b = readWithError(*values, "B", "error-b");
  print(compareFiles(*values, a, b));
  if (const auto output = values->text("output")) {
    writeImage(differenceImage(a, b), {}, *output, outputs, {DisplayView::standard});
    outputs.commit();
  }
  allowClosedOutput(); // the text is still in a buffer
  return 0;
}

} // namespace fenestra::core
