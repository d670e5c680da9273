// DICOM: the input is a child's answer about a file, which may be any bytes if a malicious file
// controls the child. ApartMutations sends files.
#include "Harness.h"

#include "files/medical/DicomReader.h"

FENESTRA_FUZZ(Dicom, input) {
  using namespace fenestra;
  const DicomHeader header = [input] {
    try {
      return parseDicomHeader(input);
    } catch (const std::runtime_error&) { // as DicomReader does
      throw inputError("slice.dcm", "is no answer");
    }
  }();
  checkDicomPixels(fuzzing::writeInput(input, "slice.dcm"), header);
  rescaleVoxels(header, std::string(imageBytes(header), '\x5a'));
}
