// Folders of masks: the input is one file, whose format the first byte selects, beside a mask.
#include "Harness.h"

#include "files/segments/MaskFolder.h"

namespace {

/// A mask of 3 x 3 x 2 voxels of 8 bits, as MetaImage.
std::string makeMask() {
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nElementSpacing = 1 1 2\n"
         "DimSize = 3 3 2\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n" +
         std::string(9, '\1') + std::string(9, '\0');
}

} // namespace

FENESTRA_FUZZ(MaskFolder, input) {
  using namespace fenestra::core;
  const std::array names{"a.nii", "b.nrrd", "c.mha", "d.mgh", "e.nii.gz"};
  static const bool isPrepared = [&] {
    for (const std::string name : names) {
      std::filesystem::create_directory(fuzzing::folder() / ("of-" + name));
      fuzzing::writeInput(makeMask(), "of-" + name + "/mask.mha");
    }
    return true;
  }();
  const std::string name = fuzzing::chooseName(input, names);
  const auto folder = fuzzing::writeInput(input, "of-" + name + "/" + name).parent_path();
  const Grid volume(Size3(3, 3, 2), Affine(Mat3::Diagonal(Vec3(-1, -1, 2)), Vec3::Zero()));
  const Segmentation segmentation = readMaskFolder(folder, &volume);
  if (!isPrepared || segmentation.segments().empty())
    throw std::logic_error("the folder has a mask");
  segmentation.makeFocusMask({"mask"}, volume);
}
