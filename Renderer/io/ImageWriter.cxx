#include "io/ImageWriter.h"

#include "core/Error.h"
#include "io/AtomicFile.h"
#include "io/DisplayTransform.h"
#include "io/ImageFormat.h"
#include "io/ImageReader.h"

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <itkImageIOBase.h>

#include <cstdint>
#include <limits>

namespace fenestra {

namespace {

/// In memory, because OpenEXR keeps silent about a disk that fills as it closes a file.
std::string encodeExr(const Image& image) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::addChromaticities(header, Imf::Chromaticities()); // Rec. 709
  for (const auto& [key, value] : image.header)
    header.insert("fenestra." + key, Imf::StringAttribute(value));
  Imf::FrameBuffer frame;
  for (const auto& [name, plane] : image.channels) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    char* const pixels = reinterpret_cast<char*>(const_cast<float*>(plane.data()));
    frame.insert(name, Imf::Slice(Imf::FLOAT, pixels, sizeof(float),
                                  sizeof(float) * static_cast<std::size_t>(image.width)));
  }
  Imf::StdOSStream stream;
  {
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(frame);
    file.writePixels(image.height);
  }
  return stream.str();
}

template <typename T>
itk::IOComponentEnum componentOf() {
  return itk::ImageIOBase::MapPixelType<T>::CType;
}

/// Writes interleaved values to the temporary file. A disk that fills in a file's last block goes
/// unnoticed by the libraries; reading back notices.
template <typename T>
void writeThroughItk(itk::ImageIOBase& io, const std::vector<T>& values, const AtomicFile& file,
                     const std::filesystem::path& path) {
  io.SetComponentType(componentOf<T>());
  io.SetFileName(file.temporaryPath().string());
  try {
    io.Write(values.data());
    readImage(file.temporaryPath());
  } catch (const std::exception&) { // ITK's text names its own source lines
    throw outputError(path.string(), "cannot be written whole; free some space on its disk");
  }
}

void setSize(itk::ImageIOBase& io, const Image& image, unsigned dimensions, unsigned components,
             itk::IOPixelEnum pixelType) {
  io.SetNumberOfDimensions(dimensions);
  for (unsigned axis = 0; axis < dimensions; ++axis)
    io.SetDimensions(axis, 1);
  io.SetDimensions(0, static_cast<std::size_t>(image.width));
  io.SetDimensions(1, static_cast<std::size_t>(image.height));
  io.SetNumberOfComponents(components);
  io.SetPixelType(pixelType);
}

/// `display`: RGBA values in [0, 1] by pixel. T is the integer type of the file.
template <typename T>
void writeDisplay(const Image& image, const std::vector<float>& display, ImageFormat format,
                  const std::filesystem::path& path) {
  bool opaque = true;
  for (std::size_t i = 3; i < display.size(); i += 4)
    opaque = opaque && display[i] >= 1.0f;
  std::vector<T> values;
  values.reserve(display.size());
  for (std::size_t i = 0; i < display.size(); ++i)
    if (!opaque || i % 4 != 3)
      values.push_back(static_cast<T>(std::lround(
          static_cast<double>(display[i]) * static_cast<double>(std::numeric_limits<T>::max()))));
  const auto io = itkImageIo(format);
  setSize(*io, image, 2, opaque ? 3 : 4, opaque ? itk::IOPixelEnum::RGB : itk::IOPixelEnum::RGBA);
  AtomicFile file(path);
  writeThroughItk(*io, values, file, path);
  file.commit();
}

/// The plane as ITK states it: LPS, whose first two axes are RAS turned round.
void setGeometry(itk::ImageIOBase& io, const ImagePlane& plane) {
  const Vec3 lpsFromRas(-1.0, -1.0, 1.0);
  // Right-handed, so that Slicer need not flip the slice; it is as thick as a pixel is wide.
  const Vec3 axes[3] = {plane.columnStep, plane.rowStep,
                        plane.columnStep.cross(plane.rowStep).normalized() *
                            plane.columnStep.norm()};
  for (unsigned axis = 0; axis < 3; ++axis) {
    const Vec3 direction = axes[axis].normalized().cwiseProduct(lpsFromRas);
    io.SetSpacing(axis, axes[axis].norm());
    io.SetOrigin(axis, plane.topLeft[axis] * lpsFromRas[axis]);
    io.SetDirection(axis, {direction.x(), direction.y(), direction.z()});
  }
}

void writeSlice(const Image& image, const ImagePlane& plane, const std::vector<float>& values,
                const AtomicFile& file, const std::filesystem::path& path) {
  const auto components = static_cast<unsigned>(values.size() / image.channels.at("R").size());
  const auto io = itkImageIo(ImageFormat::nrrd);
  setSize(*io, image, 3, components,
          components > 1 ? itk::IOPixelEnum::VECTOR : itk::IOPixelEnum::SCALAR);
  setGeometry(*io, plane);
  writeThroughItk(*io, values, file, path);
}

std::vector<float> interleavedRgba(const Image& image) {
  const std::size_t count = image.channels.at("R").size();
  std::vector<float> values(4 * count, 1.0f);
  const char* const names[4] = {"R", "G", "B", "A"};
  for (std::size_t c = 0; c < 4; ++c)
    if (const std::vector<float>* channel = image.find(names[c]))
      for (std::size_t i = 0; i < count; ++i)
        values[4 * i + c] = (*channel)[i];
  return values;
}

/// Both files are complete before either gets its name.
void writeNrrd(const Image& image, const ImagePlane& plane, const std::filesystem::path& path) {
  AtomicFile colour(path);
  writeSlice(image, plane, interleavedRgba(image), colour, path);
  if (const std::vector<float>* depth = image.find("Z")) {
    const auto depthPath = path.parent_path() / (path.stem().string() + "-Z.nrrd");
    AtomicFile file(depthPath);
    writeSlice(image, plane, *depth, file, depthPath);
    file.commit();
  }
  colour.commit();
}

ImageFormat checkedFormat(const std::filesystem::path& path) {
  if (const auto format = imageFormat(path))
    return *format;
  throw usageError("--output " + path.string() + ": has no known extension; name a file " +
                   imageExtensions);
}

void requireColour(const Image& image, const std::filesystem::path& path) {
  for (const char* name : {"R", "G", "B"})
    if (!image.find(name))
      throw usageError(path.string() + ": the picture has no channel " + name +
                       "; write it as .exr");
}

} // namespace

void writeImage(const Image& image, const ImagePlane& plane, const std::filesystem::path& path,
                const std::string& view) {
  const ImageFormat format = checkedFormat(path);
  if (format == ImageFormat::exr)
    return writeFile(path, encodeExr(image));
  requireColour(image, path);
  if (format == ImageFormat::nrrd)
    return writeNrrd(image, plane, path);
  const std::vector<float> display = toDisplay(image, DisplayTransform(view));
  if (format == ImageFormat::png)
    writeDisplay<std::uint8_t>(image, display, format, path);
  else
    writeDisplay<std::uint16_t>(image, display, format, path);
}

void checkImagePath(const std::filesystem::path& path) {
  checkedFormat(path);
  checkWritable(path);
}

} // namespace fenestra
