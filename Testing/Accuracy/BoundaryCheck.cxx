// Independent check of the clipping surface on twelve views of a knee, a liver and a vertebra.
// Prints CSV:
//
// outline points: found by bisection between rays that hit and that miss the focus.
// jumps: outline points where one part of the focus occludes another, 2 mm or more in front of it;
//   excluded from gap and cut.
// gap, cut: distances in mm along the ray at the outline: from the last point of the focus to the
//   surface just outside (within 1e-7 pixels), and by which the surface is behind that point.
// shown: rays on the focus with at most 0.2 mm, or half of the longest label voxel edge, of other
//   tissue in front of it. shown elsewhere: within half a voxel, without the rays at jumps.
// worst: the worst of the views, separately for each column.
//
// Goals for the exact boundary: a gap of at most 0.05 mm (p95) and 0.2 mm (max), 99.9 % shown.
//
//     BoundaryCheck [PIXELS [VIEWS]]     (default: 512 per side, 12 views)

#include "BoundaryMeasure.h"
#include "Subjects.h"
#include "TemporaryFolder.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>

namespace fenestra::core::accuracy {
namespace {

/// Worst values over several views, for the summary.
struct Worst {
  double jumpFraction = 0.0, rayJumpFraction = 0.0, strictFraction = 1.0, halfVoxelFraction = 1.0,
         halfVoxelSmooth = 1.0;
  Distances gap, cut;

  static void keepMaximum(Distances& worst, const Distances& other) {
    worst = {std::max(worst.mean, other.mean), std::max(worst.p95, other.p95),
             std::max(worst.max, other.max), std::max(worst.wideFraction, other.wideFraction)};
  }
  void add(const BoundaryMeasure& measure) {
    jumpFraction = std::max(jumpFraction, measure.jumpFraction);
    rayJumpFraction = std::max(rayJumpFraction, measure.rayJumpFraction);
    strictFraction = std::min(strictFraction, measure.strictFraction);
    halfVoxelFraction = std::min(halfVoxelFraction, measure.halfVoxelFraction);
    halfVoxelSmooth = std::min(halfVoxelSmooth, measure.halfVoxelSmooth);
    keepMaximum(gap, measure.gap);
    keepMaximum(cut, measure.cut);
  }
};

constexpr const char* header =
    "subject,view in degrees,boundary,outline points,jumps in percent,gap mean in mm,gap p95 in mm,"
    "gap max in mm,gap over 0.2 mm in percent,cut p95 in mm,cut max in mm,"
    "shown to 0.2 mm in percent,shown to half a voxel in percent,rays at jumps in percent,"
    "shown elsewhere in percent";

/// Prints the end of a row: the values that Worst and BoundaryMeasure have in common.
template <typename Values>
void printValues(const Values& values) {
  std::printf(",%.1f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.2f,%.2f,%.1f,%.3f\n",
              100.0 * values.jumpFraction, values.gap.mean, values.gap.p95, values.gap.max,
              100.0 * values.gap.wideFraction, values.cut.p95, values.cut.max,
              100.0 * values.strictFraction, 100.0 * values.halfVoxelFraction,
              100.0 * values.rayJumpFraction, 100.0 * values.halfVoxelSmooth);
}

constexpr const char* boundaries[] = {"spline", "exact"};

void sweep(const Subject& subject, int size, int views) {
  const FocusField field(readIndicator(subject));
  Worst worst[2];
  for (int number = 0; number < views; ++number) {
    const View view = makeView(field, number, views, size, subject.elevation);
    const FocusView focus(field, view);
    for (std::size_t i = 0; i < 2; ++i) {
      const BoundaryMeasure measure = focus.measure(makeSurface(subject, view, boundaries[i]));
      worst[i].add(measure);
      std::printf("\"%s\",%d,%s,%.0f", subject.name.c_str(), 360 * number / views, boundaries[i],
                  measure.outlinePoints);
      printValues(measure);
      std::fflush(stdout);
    }
  }
  for (std::size_t i = 0; i < 2; ++i) {
    std::printf("\"%s\",worst,%s,", subject.name.c_str(), boundaries[i]);
    printValues(worst[i]);
  }
}

/// Copy of a subject with smoothed labels, viewed from above or below.
Subject makeSmoothed(Subject subject, double smoothing, double elevation) {
  char name[100];
  std::snprintf(name, sizeof name, "%s, labels smoothed by %g mm, viewed from %g° %s",
                subject.name.c_str(), smoothing, std::abs(elevation),
                elevation > 0.0 ? "above" : "below");
  subject.name = name;
  subject.smoothing = smoothing;
  subject.elevation = elevation;
  return subject;
}

void sweepAll(int size, int views) {
  const TemporaryFolder folder;
  const char* const named = std::getenv("FENESTRA_DATA");
  const std::filesystem::path data = named ? named : FENESTRA_DATA;
  const auto torso = data / "torso_ct_ccth_a01", abdomen = data / "abdomen_ct_totalseg";
  const Subject knee = makeKnee(folder.path(), "");
  const Subject liver = {"liver", torso / "ct.nii.gz",
                         torso / "seg_totalsegmentator_rtstruct.nii.gz", "1", 1};
  const Subject vertebra = {"vertebra", abdomen / "ct.nii.gz", abdomen / "seg_multiorgan.nii.gz",
                            "20", 20};
  const Subject subjects[] = {knee, liver, vertebra, makeSmoothed(knee, 0.6, 25.0),
                              makeSmoothed(vertebra, 1.0, -25.0)};
  std::puts(header);
  for (const Subject& subject : subjects)
    if (std::filesystem::exists(subject.labelmap))
      sweep(subject, size, views);
    else
      std::fprintf(stderr, "%s: SKIPPED: the data set is not available\n", subject.name.c_str());
}

} // namespace
} // namespace fenestra::core::accuracy

int main(int argc, char** argv) {
  try {
    fenestra::core::accuracy::sweepAll(argc > 1 ? std::atoi(argv[1]) : 512,
                                       argc > 2 ? std::atoi(argv[2]) : 12);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
