// Transfer functions: Fenestra's format, and Slicer's volume properties as text and as JSON.
#include "Approx.h"
#include "Harness.h"

#include "files/appearance/TransferReader.h"

namespace {

void readTransfer(std::string_view input, const std::string& name) {
  using namespace fenestra::core;
  const TransferFunction transfer = readTransferFile(fuzzing::writeInput(input, name))
                                        .mapScalars(std::array{-1e3, 0.0, 10.0, 1e3});
  for (const double s : {-1e30, -1000.0, 0.0, 0.5, 300.0, 1e30})
    if (!(transfer.extinction(s)[0] >= 0.0) || !allFinite(transfer.albedo(s)))
      throw std::logic_error("extinction or albedo is invalid");
}

} // namespace

FENESTRA_FUZZ(Transfer, input) {
  readTransfer(input, "t.json");
}

FENESTRA_FUZZ(Property, input) {
  readTransfer(input, "t.vp");
}

FENESTRA_FUZZ(PropertyJson, input) {
  readTransfer(input, "t.vp.json");
}
