// Linear transform files: the input is what the child says of one, which is whatever a child that a
// file has taken over says. ApartMutations sends files.
#include "Harness.h"

#include "files/slicer/TransformFile.h"

FENESTRA_FUZZ(Transform, input) {
  using namespace fenestra;
  const Affine toParent = answeredTransform("t.h5", input, TransformSense::fromParent);
  if (!toParent.allFinite())
    throw std::logic_error("a map that is none");
}
