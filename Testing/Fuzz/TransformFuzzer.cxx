// Linear transform files: the input is a child's answer about a file, which may be any bytes if a
// malicious file controls the child. ApartMutations sends files.
#include "Approx.h"
#include "Harness.h"

#include "files/slicer/TransformFile.h"

FENESTRA_FUZZ(Transform, input) {
  using namespace fenestra;
  const Affine toParent = parseTransformReply("t.h5", input).inverse();
  if (!allFinite(toParent))
    throw std::logic_error("a map that is none");
}
