// Linear transform files; the first byte chooses the format.
#include "Harness.h"

#include "io/transforms/TransformFile.h"

FENESTRA_FUZZ(Transform, input) {
  using namespace fenestra;
  const std::string name =
      fuzzing::chooseName(input, std::array{"t.h5", "t.tfm", "t.mat", "t.txt"});
  const Affine toParent =
      readLinearTransform(fuzzing::asFile(input, name), TransformSense::fromParent);
  if (!toParent.matrix().allFinite())
    throw std::logic_error("a map that is none");
}
