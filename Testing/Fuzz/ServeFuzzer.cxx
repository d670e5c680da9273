// A line that a server is told. Nothing is read or written.
#include "Harness.h"

#include "cli/ServeInput.h"

FENESTRA_FUZZ(Serve, input) {
  using namespace fenestra;
  FlagValues flags(renderSyntax.flags);
  flags.add("INPUT", "volume.nrrd");
  try {
    applyChange(nlohmann::json::parse(input), flags);
  } catch (const nlohmann::json::exception&) { // is answered, as errors are
  }
}
