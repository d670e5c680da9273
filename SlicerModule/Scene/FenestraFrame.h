#pragma once
// Reads the frame file of `fenestra serve --mapped-image`, which the renderer writes while it is
// read: its latest image. Renderer/files/images/FrameFile.h describes the format. Needs only
// standard C++.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace SlicerExport {

/// An image of one camera. Pixels have row 0 at the top.
struct Frame {
  std::int64_t request = -1; ///< id of the change that it shows; -1: none
  int width = 0, height = 0;
  int fullWidth = 0, fullHeight = 0; ///< pixels at full resolution
  std::uint64_t samples = 0;         ///< per pixel
  double noise = 0.0;                ///< after denoising, if it is; NaN: unknown
  bool isLast = false;               ///< of the request
  /// The camera, RAS mm.
  std::array<double, 3> position{}, target{}, up{};
  bool isOrthographic = false;
  double extent = 0.0; ///< half the height of the image, mm; perspective: its angle, degrees
  std::vector<std::uint8_t> display; ///< RGBA, sRGB with straight alpha
  /// View-space depth of what a pixel shows, mm along the axis of the view from the camera's
  /// position: where half of the light is stopped, or else the mean of the first collisions;
  /// infinity: nothing.
  std::vector<float> depth;
};

enum class FrameState {
  complete,
  empty,   ///< there is no image yet
  busy,    ///< it is being written: read again at the next message of the renderer, or soon
  outgrown ///< the file is larger than the memory: map it again
};

/// Reads the image in the mapped file, `size` bytes aligned to 8. `frame` is set only if the result
/// is complete. Throws std::runtime_error if this is no frame file, or one of another version.
FrameState readFrame(const void* memory, std::size_t size, Frame& frame);

} // namespace SlicerExport
