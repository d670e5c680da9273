#include "io/pictures/ImageWriter.h"

#include "core/Error.h"
#include "io/AtomicFile.h"
#include "io/pictures/DisplayTransform.h"
#include "io/pictures/ImageFormat.h"
#include "io/pictures/ImageReader.h"

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <itkNrrdImageIO.h>
#include <png.h>
#include <tiffio.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>

namespace fenestra {

namespace {

Error unwritable(const std::filesystem::path& path) {
  return outputError(path.string(), "cannot be written whole; free some space on its disk");
}

/// In memory, because OpenEXR keeps silent about a disk that fills as it closes a file.
std::string encodeExr(const Image& image) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = 1;                      // noise packs no better with more work
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

bool isOpaque(const std::vector<float>& rgba) {
  for (std::size_t i = 3; i < rgba.size(); i += 4)
    if (rgba[i] < 1.0f)
      return false;
  return true;
}

/// Values in [0, 1] as integers from 0 to the largest, without alpha where it says nothing.
template <typename T>
std::vector<T> quantized(const std::vector<float>& rgba) {
  const bool opaque = isOpaque(rgba);
  std::vector<T> values;
  values.reserve(rgba.size());
  for (std::size_t i = 0; i < rgba.size(); ++i)
    if (!opaque || i % 4 != 3)
      values.push_back(static_cast<T>(
          std::lround(static_cast<double>(rgba[i]) * std::numeric_limits<T>::max())));
  return values;
}

std::string encodePng(const Image& image, const std::vector<float>& rgba) {
  const std::vector<std::uint8_t> values = quantized<std::uint8_t>(rgba);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = isOpaque(rgba) ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  png.flags = PNG_IMAGE_FLAG_FAST; // noise packs little better with twice the work
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string content(size, '\0');
  if (!png_image_write_to_memory(&png, content.data(), &size, 0, values.data(), 0, nullptr))
    throw outputError("picture as PNG", std::string(png.message) + "; write it as .exr");
  content.resize(size);
  return content;
}

void setTiffFields(TIFF* tiff, const Image& image, bool opaque) {
  const std::uint16_t straightAlpha = EXTRASAMPLE_UNASSALPHA;
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, image.width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, image.height);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 16);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, opaque ? 3 : 4);
  if (!opaque)
    TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &straightAlpha);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
  TIFFSetField(tiff, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, TIFFDefaultStripSize(tiff, 0));
}

void writeTiff(const Image& image, const std::vector<float>& rgba,
               const std::filesystem::path& path) {
  std::vector<std::uint16_t> values = quantized<std::uint16_t>(rgba);
  const std::size_t rowLength = values.size() / static_cast<std::size_t>(image.height);
  AtomicFile file(path);
  TIFFSetErrorHandler(nullptr); // standard error is ours
  std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(TIFFOpen(file.temporaryPath().c_str(), "w"),
                                              TIFFClose);
  bool good = tiff != nullptr;
  if (good)
    setTiffFields(tiff.get(), image, isOpaque(rgba));
  for (std::size_t row = 0; good && row < static_cast<std::size_t>(image.height); ++row)
    good = TIFFWriteScanline(tiff.get(), &values[row * rowLength],
                             static_cast<std::uint32_t>(row)) == 1;
  if (!good || TIFFFlush(tiff.get()) != 1)
    throw unwritable(path);
  tiff.reset();
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
    // + 0.0: no "-0" in the header
    io.SetDirection(axis, {direction.x() + 0.0, direction.y() + 0.0, direction.z() + 0.0});
  }
}

/// `values`: one or more floats by pixel. A disk that fills in a file's last block goes unnoticed
/// by ITK; reading back notices.
void writeSlice(const Image& image, const ImagePlane& plane, const std::vector<float>& values,
                const AtomicFile& file, const std::filesystem::path& path) {
  const auto components = static_cast<unsigned>(values.size() / image.channels.at("R").size());
  const auto io = itk::NrrdImageIO::New();
  io->SetNumberOfDimensions(3);
  io->SetDimensions(0, static_cast<std::size_t>(image.width));
  io->SetDimensions(1, static_cast<std::size_t>(image.height));
  io->SetDimensions(2, 1);
  setGeometry(*io, plane);
  io->SetNumberOfComponents(components);
  io->SetPixelType(components > 1 ? itk::IOPixelEnum::VECTOR : itk::IOPixelEnum::SCALAR);
  io->SetComponentType(itk::IOComponentEnum::FLOAT);
  io->SetFileName(file.temporaryPath().string());
  try {
    io->Write(values.data());
    readImage(file.temporaryPath());
  } catch (const std::exception&) { // its text names ITK's own source lines
    throw unwritable(path);
  }
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

std::filesystem::path depthPath(const std::filesystem::path& path) {
  return path.parent_path() / (path.stem().string() + "-Z.nrrd");
}

/// Both files are complete before either gets its name. One at a time: ITK's NRRD library keeps
/// its errors in one place.
void writeNrrd(const Image& image, const ImagePlane& plane, const std::filesystem::path& path) {
  static std::mutex alone;
  const std::lock_guard lock(alone);
  AtomicFile colour(path);
  writeSlice(image, plane, interleavedRgba(image), colour, path);
  if (const std::vector<float>* depth = image.find("Z")) {
    AtomicFile file(depthPath(path));
    writeSlice(image, plane, *depth, file, depthPath(path));
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
    writeFile(path, encodePng(image, display));
  else
    writeTiff(image, display, path);
}

std::vector<std::filesystem::path> imageFiles(const std::filesystem::path& path) {
  if (checkedFormat(path) == ImageFormat::nrrd)
    return {path, depthPath(path)};
  return {path};
}

void checkImagePath(const std::filesystem::path& path) {
  for (const std::filesystem::path& file : imageFiles(path))
    checkWritable(file);
}

} // namespace fenestra
