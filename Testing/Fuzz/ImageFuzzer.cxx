// Images for comparison or environment maps; the first byte selects the format.
#include "Harness.h"

#include "files/images/ImageReader.h"

FENESTRA_FUZZ(Image, input) {
  using namespace fenestra::core;
  const std::string name =
      fuzzing::chooseName(input, std::array{"p.exr", "p.png", "p.tif", "p.nrrd"});
  const Image image = readImage(fuzzing::writeInput(input, name));
  for (const auto& [channel, plane] : image.channels)
    if (plane.size() !=
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
      throw std::logic_error(channel + " differs from the image size");
}
