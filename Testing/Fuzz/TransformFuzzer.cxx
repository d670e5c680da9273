// Linear transforms: the input is the reply of the sandboxed child, which can be any bytes if a
// malicious file has taken over the child. CorruptedSandboxFiles tests the files themselves.
#include "Approx.h"
#include "Harness.h"

#include "files/slicer/TransformFile.h"

FENESTRA_FUZZ(Transform, input) {
  using namespace fenestra::core;
  const Affine toParent = parseTransformReply("t.h5", input).inverse();
  if (!allFinite(toParent))
    throw std::logic_error("the map is not finite");
}
