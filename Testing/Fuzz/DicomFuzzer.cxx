// DICOM: the input is the reply of the sandboxed child, which can be any bytes if a malicious file
// has taken over the child. CorruptedSandboxFiles tests the files themselves.
#include "Harness.h"

#include "files/medical/DicomReader.h"

FENESTRA_FUZZ(Dicom, input) {
  using namespace fenestra;
  const std::vector<DicomHeader> headers = [input] {
    try {
      return parseDicomHeaders(input);
    } catch (const std::runtime_error&) { // as DicomReader does
      throw inputError("slice.dcm", "is not a valid reply");
    }
  }();
  for (const DicomHeader& header : headers) {
    checkDicomPixels(fuzzing::writeInput(input, "slice.dcm"), header);
    rescaleVoxels(header, std::string(imageBytes(header), '\x5a'));
  }
}
