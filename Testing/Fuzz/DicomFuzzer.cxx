// DICOM: the input is one slice of two; the other is whole.
#include "Harness.h"

#include "io/medical/DicomSeries.h"

FENESTRA_FUZZ(Dicom, input) {
  using namespace fenestra;
  const auto slice = fuzzing::asFile(input, "slice.dcm");
  try {
    chooseSeries(findDicomSeries(fuzzing::folder().path()), std::nullopt, "folder");
  } catch (const Error&) { // refused, or none at all: it may be readable by name all the same
  }
  readDicomVolume({slice}, "CT");
}
