#include "files/pictures/ImageReader.h"

#include "base/Error.h"
#include "base/safe/Inputs.h"
#include "base/safe/NrrdHeader.h"
#include "files/pictures/ExrHeader.h"
#include "files/pictures/ImageFormat.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <itkNrrdImageIO.h>
#include <png.h>
#include <tiffio.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>

namespace fenestra {
namespace {

constexpr std::int64_t largestSide = 32768;
/// Most pixels times channels: 1 GiB of floats, so that two pictures to compare, or a map of light
/// and its picture, take about 2 GiB.
constexpr std::int64_t mostSamples = std::int64_t{1} << 28;

/// Checks untrusted sizes before memory is taken. No format packs more than about 4096 samples into
/// a byte (deflate: 1032 bytes per byte, 1-bit pictures are rare); 2^20 more are allowed for tiny
/// files.
void checkSize(const std::filesystem::path& path, std::int64_t width, std::int64_t height,
               std::int64_t channels) {
  const std::string size = textOf(width, 'x', height);
  if (width < 1 || height < 1 || width > largestSide || height > largestSide)
    throw inputError(path, "is ", size, " pixels; each side must be 1 to ", largestSide);
  const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(path));
  if (channels > ((1 << 20) + 4096 * bytes) / (width * height))
    throw inputError(path, "is too short for ", channels, " channels of ", size,
                     " pixels; write it again");
  if (channels > mostSamples / (width * height))
    throw inputError(path, "has ", width * height * channels, " samples; at most ", mostSamples,
                     " are read, so use fewer pixels or channels");
}

std::string firstLine(const std::exception& error) {
  const std::string text = error.what();
  return text.substr(0, text.find('\n'));
}

void checkExr(const std::filesystem::path& path, const Imf::Header& header) {
  const auto& window = header.dataWindow();
  std::int64_t channels = 0;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it, ++channels)
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
      throw inputError(path, "has subsampled channels; write them at full resolution");
  if (header.hasType() && Imf::isDeepData(header.type()))
    throw inputError(path, "holds deep pixels; flatten them first");
  checkSize(path, std::int64_t{window.max.x} - window.min.x + 1,
            std::int64_t{window.max.y} - window.min.y + 1, channels);
}

std::map<std::string, std::string> ownAttributes(const Imf::Header& header) {
  const std::string prefix = "fenestra.";
  std::map<std::string, std::string> found;
  for (auto it = header.begin(); it != header.end(); ++it) {
    const std::string name = it.name();
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
    if (text && name.starts_with(prefix))
      found[name.substr(prefix.size())] = text->value();
  }
  return found;
}

Image readExr(const std::filesystem::path& path) {
  // OpenEXR allocates tables of offsets and tiles before it returns the header.
  checkExrAttributes(path);
  constexpr int side = static_cast<int>(largestSide);
  Imf::Header::setMaxImageSize(side, side);
  Imf::Header::setMaxTileSize(4096, 4096);
  Imf::InputFile file(path.c_str());
  checkExr(path, file.header());
  if (!file.isComplete())
    throw inputError(path, "lacks some of its lines or tiles; write it again");
  const auto window = file.header().dataWindow();
  Image image;
  image.width = window.max.x - window.min.x + 1;
  image.height = window.max.y - window.min.y + 1;
  image.header = ownAttributes(file.header());
  const auto width = static_cast<std::size_t>(image.width);
  const auto& channels = file.header().channels();
  Imf::FrameBuffer frame;
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    auto& plane = image.channels[it.name()];
    plane.resize(width * static_cast<std::size_t>(image.height));
    frame.insert(it.name(), Imf::Slice::Make(Imf::FLOAT, plane.data(), window, sizeof(float),
                                             sizeof(float) * width));
  }
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
  return image;
}

/// Channel names by the number of components; no names: not supported; empty name: grey.
std::vector<std::string> channelNames(ImageFormat format, unsigned components) {
  if (components == 3)
    return {"R", "G", "B"};
  if (components == 4)
    return {"R", "G", "B", "A"};
  if (format == ImageFormat::nrrd)
    return components == 1 ? std::vector<std::string>{"Z"} : std::vector<std::string>();
  return components == 1 ? std::vector<std::string>{""} : std::vector<std::string>{"", "A"};
}

/// Splits interleaved samples into planes; integers become [0, 1].
template <typename T>
void unpack(const std::vector<char>& bytes, const std::vector<std::string>& names, Image& image) {
  const T* const samples = reinterpret_cast<const T*>(bytes.data());
  const std::size_t count =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  const auto scale =
      std::is_integral_v<T> ? static_cast<float>(std::numeric_limits<T>::max()) : 1.0f;
  for (std::size_t c = 0; c < names.size(); ++c) {
    std::vector<float> plane(count);
    for (std::size_t i = 0; i < count; ++i)
      plane[i] = static_cast<float>(samples[i * names.size() + c]) / scale;
    if (names[c].empty())
      image.channels["R"] = image.channels["G"] = image.channels["B"] = std::move(plane);
    else
      image.channels[names[c]] = std::move(plane);
  }
}

/// Reads by libpng's simplified interface, which converts every kind of PNG to 8 bit.
Image readPng(const std::filesystem::path& path) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, void (*)(png_image*)> cleanup(&png, png_image_free);
  if (!png_image_begin_read_from_file(&png, path.c_str()))
    throw std::runtime_error(png.message);
  const bool hasAlpha = (png.format & PNG_FORMAT_FLAG_ALPHA) != 0;
  png.format = hasAlpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
  png.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  checkSize(path, png.width, png.height, hasAlpha ? 4 : 3);
  std::vector<char> bytes(PNG_IMAGE_SIZE(png));
  if (!png_image_finish_read(&png, nullptr, bytes.data(), 0, nullptr))
    throw std::runtime_error(png.message);
  Image image{static_cast<int>(png.width), static_cast<int>(png.height), {}, {}};
  unpack<std::uint8_t>(bytes, channelNames(ImageFormat::png, hasAlpha ? 4 : 3), image);
  return image;
}

std::uint32_t tiffField(TIFF* tiff, std::uint32_t tag) {
  std::uint16_t value = 0;
  TIFFGetFieldDefaulted(tiff, tag, &value);
  return value;
}

/// Throws Error (input) unless the file has rows of interleaved unsigned samples, grey or RGB.
void checkTiff(const std::filesystem::path& path, TIFF* tiff) {
  const auto bits = tiffField(tiff, TIFFTAG_BITSPERSAMPLE);
  const auto samples = tiffField(tiff, TIFFTAG_SAMPLESPERPIXEL);
  const auto photometric = tiffField(tiff, TIFFTAG_PHOTOMETRIC);
  const bool known = (bits == 8 || bits == 16) &&
                     photometric == (samples < 3 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB) &&
                     tiffField(tiff, TIFFTAG_SAMPLEFORMAT) == SAMPLEFORMAT_UINT;
  if (!known || samples < 1 || samples > 4 || TIFFIsTiled(tiff) ||
      tiffField(tiff, TIFFTAG_PLANARCONFIG) != PLANARCONFIG_CONTIG)
    throw inputError(path, "is not grey or RGB of 8 or 16 bit in interleaved rows; convert it");
  if (const auto orientation = tiffField(tiff, TIFFTAG_ORIENTATION);
      orientation != ORIENTATION_TOPLEFT)
    throw inputError(path, "Orientation: is ", orientation,
                     ", a turned or mirrored picture; save it upright");
}

std::vector<char> readTiffRows(TIFF* tiff, std::size_t rowBytes, std::uint32_t height) {
  if (static_cast<std::size_t>(TIFFScanlineSize(tiff)) != rowBytes)
    throw std::runtime_error("rows of another length");
  std::vector<char> bytes(rowBytes * height);
  for (std::uint32_t row = 0; row < height; ++row)
    if (TIFFReadScanline(tiff, &bytes[row * rowBytes], row) != 1)
      throw std::runtime_error("row " + std::to_string(row) + " cannot be decoded");
  return bytes;
}

Image readTiff(const std::filesystem::path& path) {
  TIFFSetErrorHandler(nullptr); // silent on standard error
  TIFFSetWarningHandler(nullptr);
  // m: no memory mapping, in which a file that shrinks kills its reader.
  const std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(TIFFOpen(path.c_str(), "rm"), TIFFClose);
  if (!tiff)
    throw std::runtime_error("no TIFF directory");
  checkTiff(path, tiff.get());
  std::uint32_t width = 0, height = 0;
  TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &height);
  const auto samples = tiffField(tiff.get(), TIFFTAG_SAMPLESPERPIXEL);
  const bool wide = tiffField(tiff.get(), TIFFTAG_BITSPERSAMPLE) == 16;
  checkSize(path, width, height, samples < 3 ? samples + 2 : samples); // grey becomes R, G, B
  const auto bytes =
      readTiffRows(tiff.get(), std::size_t{width} * samples * (wide ? 2 : 1), height);
  Image image{static_cast<int>(width), static_cast<int>(height), {}, {}};
  const auto unpackAs = wide ? unpack<std::uint16_t> : unpack<std::uint8_t>;
  unpackAs(bytes, channelNames(ImageFormat::tiff, samples), image);
  return image;
}

/// True if every axis beyond the second has size 1.
bool isOnePicture(const itk::ImageIOBase& io) {
  bool one = io.GetNumberOfDimensions() >= 2;
  for (unsigned axis = 2; axis < io.GetNumberOfDimensions(); ++axis)
    one = one && io.GetDimensions(axis) == 1;
  return one;
}

Image readNrrd(const std::filesystem::path& path) {
  if (readNrrdHeader(path).fields.contains("datafile"))
    throw inputError(path, "keeps its data outside; store them in the file itself");
  const auto io = itk::NrrdImageIO::New();
  io->SetFileName(path.string());
  io->ReadImageInformation();
  const auto names = channelNames(ImageFormat::nrrd, io->GetNumberOfComponents());
  if (!isOnePicture(*io) || names.empty() || io->GetComponentType() != itk::IOComponentEnum::FLOAT)
    throw inputError(path, "is not one slice of 1, 3 or 4 floats a pixel; extract one");
  checkSize(path, static_cast<std::int64_t>(io->GetDimensions(0)),
            static_cast<std::int64_t>(io->GetDimensions(1)), io->GetNumberOfComponents());
  Image image{
      static_cast<int>(io->GetDimensions(0)), static_cast<int>(io->GetDimensions(1)), {}, {}};
  std::vector<char> bytes(static_cast<std::size_t>(io->GetImageSizeInBytes()));
  io->Read(bytes.data());
  unpack<float>(bytes, names, image);
  return image;
}

Image readAs(ImageFormat format, const std::filesystem::path& path) {
  if (format == ImageFormat::exr)
    return readExr(path);
  if (format == ImageFormat::nrrd)
    return readNrrd(path);
  return format == ImageFormat::png ? readPng(path) : readTiff(path);
}

} // namespace

Image readImage(const std::filesystem::path& path) {
  requireFile(path, "name an image");
  const auto format = imageFormat(path);
  if (!format)
    throw inputError(path, "has no known extension; name an image ", imageExtensions);
  try {
    return readAs(*format, path);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw inputError(path, "does not fit into memory; use a smaller image");
  } catch (const itk::ExceptionObject&) { // its text names ITK's own source lines
    throw inputError(path, "is damaged or not of its extension's format; write it again");
  } catch (const std::exception& error) {
    throw inputError(path, "is damaged or not of its extension's format (", firstLine(error),
                     "); write it again");
  }
}

} // namespace fenestra
