#include "files/images/ImageReader.h"

#include "base/Error.h"
#include "base/TextStream.h"
#include "files/formats/NrrdHeader.h"
#include "files/images/ImageFormat.h"
#include "io/InputRegistry.h"

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

namespace fenestra::core {
namespace {

constexpr std::int64_t maxSide = 32768;
/// Limit of pixels times channels: 1 GiB of floats. Comparing two images, or holding an environment
/// map and its image, then takes about 2 GiB.
constexpr std::int64_t maxSamples = std::int64_t{1} << 28;

/// Checks untrusted dimensions before allocating memory. No format stores more than about 4096
/// samples per byte (deflate expands up to 1032 times, and 1-bit images are rare). Tiny files may
/// have 2^20 more.
void checkSize(const std::filesystem::path& path, std::int64_t width, std::int64_t height,
               std::int64_t channels) {
  const std::string size = concat(width, 'x', height);
  if (width < 1 || height < 1 || width > maxSide || height > maxSide)
    throw inputError(path, "is ", size, " pixels; each side must be 1 to ", maxSide);
  const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(path));
  if (channels > ((1 << 20) + 4096 * bytes) / (width * height))
    throw inputError(ErrorCode::damagedFile, path, "is too short for ", channels, " channels of ",
                     size, " pixels; write it again");
  if (channels > maxSamples / (width * height))
    throw inputError(ErrorCode::limitExceeded, path, "has ", width * height * channels,
                     " samples, more than the limit of ", maxSamples,
                     "; reduce pixels or channels");
}

// ---- EXR

/// Sizes in bytes of the fixed-size attribute types ("OpenEXR File Layout", openexr.com).
const std::map<std::string, std::uint32_t> fixedSizes = {
    {"box2f", 16},   {"box2i", 16},         {"compression", 1}, {"chromaticities", 32},
    {"double", 8},   {"deepImageState", 1}, {"envmap", 1},      {"float", 4},
    {"int", 4},      {"keycode", 28},       {"lineOrder", 1},   {"m33d", 72},
    {"m33f", 36},    {"m44d", 128},         {"m44f", 64},       {"rational", 8},
    {"tiledesc", 9}, {"timecode", 8},       {"v2d", 16},        {"v2f", 8},
    {"v2i", 8},      {"v3d", 24},           {"v3f", 12},        {"v3i", 12}};

std::uint32_t readLittleEndian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4 && at + i < bytes.size(); ++i)
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return value;
}

/// True for a list of channels (each a name and 16 bytes) that ends in an empty name.
bool isChannelList(const std::string& value) {
  std::size_t at = 0;
  while (at < value.size() && value[at] != '\0') {
    at = value.find('\0', at);
    at = at == std::string::npos ? value.size() : at + 17;
  }
  return at + 1 == value.size();
}

bool isStringVector(const std::string& value) {
  std::uint64_t at = 0;
  while (at + 4 <= value.size())
    at += std::uint64_t{4} + readLittleEndian(value, at);
  return at == value.size();
}

/// True for width, height, and as many pixels of four bytes.
bool isPreview(const std::string& value) {
  const std::uint64_t width = readLittleEndian(value, 0), height = readLittleEndian(value, 4);
  return value.size() >= 8 && width <= value.size() && height <= value.size() &&
         8 + 4 * width * height == value.size();
}

/// True if `value` is exactly one value of `type`. Unknown types pass, since OpenEXR reads those by
/// their declared size.
bool hasExactSize(const std::string& type, const std::string& value) {
  if (const auto fixed = fixedSizes.find(type); fixed != fixedSizes.end())
    return value.size() == fixed->second;
  if (type == "chlist")
    return isChannelList(value);
  if (type == "stringvector")
    return isStringVector(value);
  if (type == "preview")
    return isPreview(value);
  if (type == "floatvector")
    return value.size() % 4 == 0;
  return type != "idmanifest"; // occurs with deep pixels only, which are not read
}

/// Throws std::runtime_error unless every attribute ends within the file and has exactly its
/// declared size. OpenEXR allocates any declared size before it reads. It also ignores the size of
/// most types and then misreads everything that follows.
void checkExrAttributes(const std::filesystem::path& path) {
  ThrowingStream<std::ifstream> file(path, std::ios::binary);
  const auto length = static_cast<std::int64_t>(std::filesystem::file_size(path));
  file.seekg(5); // flags of the version field
  const bool isMultiPart = (file.get() & 0x10) != 0;
  file.seekg(8);
  std::string name, type, size(4, '\0'), value;
  do { // one header per part, then an empty header
    while (std::getline(file, name, '\0') && !name.empty() && std::getline(file, type, '\0')) {
      file.read(size.data(), 4);
      if (!file || readLittleEndian(size, 0) > length - file.tellg())
        throw std::runtime_error("an attribute extends beyond the end of the file");
      value.resize(readLittleEndian(size, 0));
      file.read(value.data(), static_cast<std::streamsize>(value.size()));
      if (!hasExactSize(type, value))
        throw std::runtime_error("an attribute does not match its declared size");
    }
  } while (isMultiPart && file.peek() > 0);
}

void checkExr(const std::filesystem::path& path, const Imf::Header& header) {
  const auto& window = header.dataWindow();
  std::int64_t channels = 0;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it, ++channels)
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
      throw inputError(ErrorCode::unsupportedFile, path,
                       "has subsampled channels; write them at full resolution");
  if (header.hasType() && Imf::isDeepData(header.type()))
    throw inputError(ErrorCode::unsupportedFile, path, "has deep pixels; flatten the image first");
  checkSize(path, std::int64_t{window.max.x} - window.min.x + 1,
            std::int64_t{window.max.y} - window.min.y + 1, channels);
}

std::map<std::string, std::string> readFenestraAttributes(const Imf::Header& header) {
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
  // OpenEXR allocates offset and tile tables before it returns the header.
  checkExrAttributes(path);
  constexpr int side = static_cast<int>(maxSide);
  Imf::Header::setMaxImageSize(side, side);
  Imf::Header::setMaxTileSize(4096, 4096);
  Imf::InputFile file(path.c_str());
  checkExr(path, file.header());
  if (!file.isComplete())
    throw inputError(ErrorCode::damagedFile, path,
                     "lacks some scan lines or tiles; write it again");
  const auto window = file.header().dataWindow();
  Image image;
  image.width = window.max.x - window.min.x + 1;
  image.height = window.max.y - window.min.y + 1;
  image.header = readFenestraAttributes(file.header());
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

// ---- PNG, TIFF, NRRD

/// Channel names for a number of components. An empty name means gray, an empty list unsupported.
std::vector<std::string> chooseChannelNames(ImageFormat format, unsigned components) {
  if (components == 3)
    return {"R", "G", "B"};
  if (components == 4)
    return {"R", "G", "B", "A"};
  if (format == ImageFormat::nrrd)
    return components == 1 ? std::vector<std::string>{"Z"} : std::vector<std::string>();
  return components == 1 ? std::vector<std::string>{""} : std::vector<std::string>{"", "A"};
}

/// Image of interleaved samples; integers are scaled to [0, 1].
template <typename T>
Image deinterleave(const std::vector<char>& bytes, const std::vector<std::string>& names,
                   std::size_t width, std::size_t height) {
  const T* const samples = reinterpret_cast<const T*>(bytes.data());
  const auto scale =
      std::is_integral_v<T> ? static_cast<float>(std::numeric_limits<T>::max()) : 1.0f;
  Image image{static_cast<int>(width), static_cast<int>(height), {}, {}};
  for (std::size_t c = 0; c < names.size(); ++c) {
    std::vector<float> plane(width * height);
    for (std::size_t i = 0; i < plane.size(); ++i)
      plane[i] = static_cast<float>(samples[i * names.size() + c]) / scale;
    if (names[c].empty())
      image.channels["R"] = image.channels["G"] = image.channels["B"] = std::move(plane);
    else
      image.channels[names[c]] = std::move(plane);
  }
  return image;
}

/// Uses libpng's simplified interface, which converts every kind of PNG to 8 bits.
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
  return deinterleave<std::uint8_t>(bytes, chooseChannelNames(ImageFormat::png, hasAlpha ? 4 : 3),
                                    png.width, png.height);
}

std::uint32_t readTiffField(TIFF* tiff, std::uint32_t tag) {
  std::uint16_t value = 0;
  TIFFGetFieldDefaulted(tiff, tag, &value);
  return value;
}

/// Throws Error (input) unless the file has rows of interleaved unsigned samples, gray or RGB.
void checkTiff(const std::filesystem::path& path, TIFF* tiff) {
  const auto bits = readTiffField(tiff, TIFFTAG_BITSPERSAMPLE);
  const auto samples = readTiffField(tiff, TIFFTAG_SAMPLESPERPIXEL);
  const auto photometric = readTiffField(tiff, TIFFTAG_PHOTOMETRIC);
  const bool isSupported =
      (bits == 8 || bits == 16) &&
      photometric == (samples < 3 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB) &&
      readTiffField(tiff, TIFFTAG_SAMPLEFORMAT) == SAMPLEFORMAT_UINT;
  if (!isSupported || samples < 1 || samples > 4 || TIFFIsTiled(tiff) ||
      readTiffField(tiff, TIFFTAG_PLANARCONFIG) != PLANARCONFIG_CONTIG)
    throw inputError(ErrorCode::unsupportedFile, path,
                     "is not 8- or 16-bit gray or RGB in interleaved rows; convert it");
  if (const auto orientation = readTiffField(tiff, TIFFTAG_ORIENTATION);
      orientation != ORIENTATION_TOPLEFT)
    throw fieldError(path, "Orientation", "is ", orientation,
                     ", so the image is rotated or mirrored; save it upright");
}

std::vector<char> readTiffRows(TIFF* tiff, std::size_t rowBytes, std::uint32_t height) {
  if (static_cast<std::size_t>(TIFFScanlineSize(tiff)) != rowBytes)
    throw std::runtime_error("rows have an unexpected length");
  std::vector<char> bytes(rowBytes * height);
  for (std::uint32_t row = 0; row < height; ++row)
    if (TIFFReadScanline(tiff, &bytes[row * rowBytes], row) != 1)
      throw std::runtime_error("row " + std::to_string(row) + " cannot be decoded");
  return bytes;
}

Image readTiff(const std::filesystem::path& path) {
  TIFFSetErrorHandler(nullptr); // keep stderr clean
  TIFFSetWarningHandler(nullptr);
  // "m" disables memory mapping: if the file shrank, the mapping would kill this process.
  const std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(TIFFOpen(path.c_str(), "rm"), TIFFClose);
  if (!tiff)
    throw std::runtime_error("no TIFF directory");
  checkTiff(path, tiff.get());
  std::uint32_t width = 0, height = 0;
  TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &height);
  const auto samples = readTiffField(tiff.get(), TIFFTAG_SAMPLESPERPIXEL);
  const bool is16Bit = readTiffField(tiff.get(), TIFFTAG_BITSPERSAMPLE) == 16;
  checkSize(path, width, height, samples < 3 ? samples + 2 : samples); // gray becomes R, G, B
  const auto bytes =
      readTiffRows(tiff.get(), std::size_t{width} * samples * (is16Bit ? 2 : 1), height);
  const auto unpack = is16Bit ? deinterleave<std::uint16_t> : deinterleave<std::uint8_t>;
  return unpack(bytes, chooseChannelNames(ImageFormat::tiff, samples), width, height);
}

/// True if every axis beyond the second has size 1.
bool isSingleImage(const itk::ImageIOBase& io) {
  bool one = io.GetNumberOfDimensions() >= 2;
  for (unsigned axis = 2; axis < io.GetNumberOfDimensions(); ++axis)
    one = one && io.GetDimensions(axis) == 1;
  return one;
}

Image readNrrd(const std::filesystem::path& path) {
  if (readNrrdHeader(path).fields.contains("datafile"))
    throw inputError(ErrorCode::unsupportedFile, path,
                     "has its samples in another file; store them in this one");
  const auto io = itk::NrrdImageIO::New();
  io->SetFileName(path.string());
  io->ReadImageInformation();
  const auto names = chooseChannelNames(ImageFormat::nrrd, io->GetNumberOfComponents());
  if (!isSingleImage(*io) || names.empty() || io->GetComponentType() != itk::IOComponentEnum::FLOAT)
    throw inputError(ErrorCode::unsupportedFile, path,
                     "is not one slice of 1, 3 or 4 floats per pixel; extract one");
  const std::size_t width = io->GetDimensions(0), height = io->GetDimensions(1);
  checkSize(path, static_cast<std::int64_t>(width), static_cast<std::int64_t>(height),
            io->GetNumberOfComponents());
  std::vector<char> bytes(static_cast<std::size_t>(io->GetImageSizeInBytes()));
  io->Read(bytes.data());
  return deinterleave<float>(bytes, names, width, height);
}

} // namespace

Image readImage(const std::filesystem::path& path) {
  requireFile(path, "give an image in it");
  const auto format = findImageFormat(path);
  if (!format)
    throw inputError(ErrorCode::unsupportedFile, path, "has an unknown extension; give an image ",
                     imageExtensions);
  try {
    switch (*format) {
    case ImageFormat::exr:
      return readExr(path);
    case ImageFormat::nrrd:
      return readNrrd(path);
    case ImageFormat::png:
      return readPng(path);
    case ImageFormat::tiff:
      break;
    }
    return readTiff(path);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw inputError(ErrorCode::outOfMemory, path, "does not fit into memory; use a smaller image");
  } catch (const itk::ExceptionObject&) { // its text names ITK's source lines
    throw inputError(ErrorCode::damagedFile, path,
                     "is damaged or does not match its extension; write it again");
  } catch (const std::exception& error) {
    const std::string_view text = error.what();
    throw inputError(ErrorCode::damagedFile, path, "is damaged or does not match its extension (",
                     text.substr(0, text.find('\n')), "); write it again");
  }
}

} // namespace fenestra::core
