// From a pixel of an image to the anatomy, with depths that the real renderer writes.

#include "FenestraImage.h"
#include "FenestraImagePoint.h"
#include "TemporaryFolder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <memory>

namespace fenestra::core {
namespace {

using SlicerExport::Point;

/// A dense cube of 20 mm around (3, -2, 5) in air, as a NRRD file.
void writeCube(const std::filesystem::path& file) {
  constexpr std::size_t edge = 40; // voxels of 1 mm
  SlicerExport::Image image;
  image.type = "int16";
  image.size = {edge, edge, edge};
  image.ijkToRas = {1, 0, 0, 3 - 19.5, 0, 1, 0, -2 - 19.5, 0, 0, 1, 5 - 19.5, 0, 0, 0, 1};
  const std::shared_ptr<std::int16_t[]> voxels(new std::int16_t[edge * edge * edge]);
  for (std::size_t i = 0; i < edge * edge * edge; ++i) {
    const auto isInside = [](std::size_t index) { return index >= 10 && index < 30; };
    const bool isCube =
        isInside(i % edge) && isInside(i / edge % edge) && isInside(i / edge / edge);
    voxels[i] = static_cast<std::int16_t>(isCube ? 2000 : -1000);
  }
  image.data = std::shared_ptr<const void>(voxels, voxels.get());
  SlicerExport::writeNrrd(image, file);
}

/// Renders the cube from 100 mm in front of it and 40 mm to the right. The middle of the image is
/// the target, (3, 8, 5), in the middle of the front face.
SlicerExport::Image renderDepth(const std::filesystem::path& folder, const std::string& options,
                                const std::string& layer) {
  writeCube(folder / "cube.nrrd");
  const std::string command =
      std::string("cd '") + folder.string() + "' && '" + FENESTRA_EXECUTABLE +
      "' cube.nrrd --transfer ct-bone --density-scale 1000 --size 41x31 --samples 4 --quiet "
      "--position 43,108,5 --target 3,8,5 --up 0,0,1 --layers color,depth,depth50 "
      "--output image.png --output image.nrrd " +
      options;
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  return SlicerExport::readNrrd(folder / ("image-" + layer + ".nrrd"));
}

Point pixelCenter(const SlicerExport::Image& image, double column, double row) {
  Point point = {};
  for (std::size_t i = 0; i < 3; ++i)
    point[i] = image.ijkToRas[4 * i] * column + image.ijkToRas[4 * i + 1] * row +
               image.ijkToRas[4 * i + 3];
  return point;
}

/// Where the ray of a pixel, counted from the middle to the right and upward, meets y = 8.
Point findFacePoint(bool isOrthographic, double right, double up) {
  const double distance = std::hypot(40.0, 100.0); // of the target
  const double pitch =
      (isOrthographic ? 15.0 : distance * std::tan(10.0 * std::acos(-1.0) / 180.0)) / 15.5;
  // The axis is (-40, -100, 0) / distance; right of it, seen upright, is (-100, 40, 0) / distance.
  const double x = -100.0 / distance * pitch * right, y = 40.0 / distance * pitch * right;
  if (isOrthographic)
    return {3.0 + x - 0.4 * y, 8.0, 5.0 + pitch * up};
  const double t = 100.0 / (100.0 - y);
  return {43.0 + t * (-40.0 + x), 8.0, 5.0 + t * pitch * up};
}

TEST(SlicerImagePoint, PixelsOfAFaceLieOnIt) {
  for (const char* options :
       {"--projection orthographic --scale 15", "--projection perspective --angle 20"})
    for (const char* layer : {"depth50", "Z"}) {
      SCOPED_TRACE(std::string(options) + " " + layer);
      const TemporaryFolder folder;
      const SlicerExport::Image depth = renderDepth(folder.path(), options, layer);
      const auto camera =
          SlicerExport::parseImageCamera(depth.fields.at(SlicerExport::cameraField));
      ASSERT_TRUE(camera);
      EXPECT_EQ(camera->isOrthographic, std::string(options).find("ortho") != std::string::npos);
      const auto* const values = static_cast<const float*>(depth.data.get());
      for (const int column : {16, 20, 24})
        for (const int row : {10, 15, 20}) {
          const Point point =
              SlicerExport::findImagePoint(*camera, pixelCenter(depth, column, row),
                                           static_cast<double>(values[41 * row + column]));
          const Point expected = findFacePoint(camera->isOrthographic, column - 20, 15 - row);
          for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(point[i], expected[i], 0.6) << column << " " << row << " " << i;
        }
      EXPECT_FALSE(std::isfinite(values[0])); // beside the cube
    }
}

TEST(SlicerImagePoint, IncompleteCamerasAreRefused) {
  const std::string complete = "--projection orthographic --position=1,2,3 --target 4,5,6";
  EXPECT_TRUE(SlicerExport::parseImageCamera(complete));
  for (const char* text :
       {"", "--projection orthographic", "--projection orthographic --position=1,2,3",
        "--projection other --position=1,2,3 --target=4,5,6",
        "--projection perspective --position=1,2 --target=4,5,6",
        "--projection perspective --position=a,b,c --target=4,5,6"})
    EXPECT_FALSE(SlicerExport::parseImageCamera(text)) << text;
}

} // namespace
} // namespace fenestra::core
