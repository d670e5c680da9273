// Transfer functions of the kind that FENESTRA_FUZZ_FILE ends like.
#include "Harness.h"

#include "io/looks/TransferReader.h"

FENESTRA_FUZZ(input) {
  using namespace fenestra;
  const TransferFunction transfer =
      readTransferLook(fuzzing::asFile(input, FENESTRA_FUZZ_FILE)).over(-1e3, 1e3);
  for (const double s : {-1e30, -1000.0, 0.0, 0.5, 300.0, 1e30})
    if (!(transfer.extinction(s)[0] >= 0.0) || !transfer.albedo(s).isFinite().all())
      throw std::logic_error("a medium that is none");
}
