// DICOM images: the input is the reply of the sandboxed child, which can be any bytes if a
// malicious file has taken over the child. CorruptedSandboxFiles tests the files themselves.
#include "Harness.h"

#include "files/medical/DicomSeries.h"
#include "files/medical/DicomSpacing.h"
#include "files/medical/StandardUptake.h"

namespace {

/// Evens the spacing of slices and converts PET, as readDicomVolume does before it reads voxels.
void place(fenestra::core::DicomSlices& slices, const fenestra::core::DicomSeries& series) {
  using namespace fenestra::core;
  std::vector<Message> warnings;
  convertToSuv(slices, series, "series", warnings);
  std::vector<PlacedSlice> placed;
  for (const DicomSlice& slice : slices)
    if (slice.header.position.size() == 3 && slice.header.pixelSpacing.size() == 2)
      placed.push_back({"slice", getPosition(slice)});
  const auto axes = findAxes(slices.front().header.orientation);
  if (!axes || placed.empty() || placed.size() != slices.size())
    return;
  const std::vector<double>& pixel = slices.front().header.pixelSpacing;
  std::ranges::stable_sort(
      placed, {}, [&](const PlacedSlice& one) { return one.position.dot(axes->normal()); });
  computeSpacing(placed, axes->normal(), {axes->row, axes->column}, {pixel[1], pixel[0]}, "series",
                 warnings);
}

} // namespace

FENESTRA_FUZZ(Dicom, input) {
  using namespace fenestra::core;
  const std::vector<DicomHeader> headers = [input] {
    try {
      return parseDicomHeaders(input, "slice.dcm");
    } catch (const std::runtime_error&) { // as DicomReader does
      throw inputError("slice.dcm", "is not a valid reply");
    }
  }();
  const auto path = fuzzing::writeInput(input, "slice.dcm");
  const auto empty = fuzzing::writeInput("", "empty.dcm"); // has no voxels to compare in a child
  DicomSlices slices;
  for (DicomHeader header : headers) {
    header.isCompressed = false;
    slices.push_back({empty, header});
  }
  for (const DicomSeries& series : splitSeries(std::move(slices), "series"))
    for (DicomSlices frame : series.frames)
      place(frame, series);
  checkDicomPixels(path, headers.front());
  rescaleVoxels(headers.front(), std::string(imageBytes(headers.front()), '\x5a'));
}
