#include "io/ImageReader.h"

#include "core/Error.h"
#include "io/ImageFormat.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <itkImageIOBase.h>

#include <cstdint>
#include <fstream>
#include <limits>

namespace fenestra {

namespace {

constexpr std::int64_t largestSide = 32768;

/// Untrusted sizes, before memory is taken for them. No format packs more than about 4096 samples
/// in a byte (deflate reaches 1032 bytes a byte, 1-bit pictures are rare); tiny files may.
void checkSize(const std::filesystem::path& path, std::int64_t width, std::int64_t height,
               std::int64_t channels) {
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  if (width < 1 || height < 1 || width > largestSide || height > largestSide)
    throw inputError(path.string(), "is " + size + " pixels; each side must be 1 to " +
                                        std::to_string(largestSide));
  const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(path));
  if (channels > ((1 << 20) + 4096 * bytes) / (width * height))
    throw inputError(path.string(), "is too short for " + std::to_string(channels) +
                                        " channels of " + size + " pixels; write it again");
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
      throw inputError(path.string(), std::string("channel ") + it.name() +
                                          " is subsampled; write it at full resolution");
  if (header.hasType() && Imf::isDeepData(header.type()))
    throw inputError(path.string(), "holds deep pixels; flatten them first");
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
  // OpenEXR allocates tables of offsets and tiles before we see the header.
  constexpr int side = static_cast<int>(largestSide);
  Imf::Header::setMaxImageSize(side, side);
  Imf::Header::setMaxTileSize(4096, 4096);
  Imf::InputFile file(path.c_str());
  checkExr(path, file.header());
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

/// A NRRD header can send its reader to other files or to standard input.
void checkAttached(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line(4096, '\0');
  while (file.getline(line.data(), static_cast<std::streamsize>(line.size()))) {
    const std::string_view field(line.c_str());
    if (field.empty() || field == "\r")
      return;
    if (field.starts_with("data file:") || field.starts_with("datafile:"))
      throw inputError(path.string(), "keeps its data outside; store them in the file itself");
  }
}

/// Channel names by the number of components; empty names mean grey.
std::vector<std::string> channelNames(ImageFormat format, unsigned components) {
  const std::vector<std::string> byCount[5] = {{},
                                               {format == ImageFormat::nrrd ? "Z" : ""},
                                               {"", "A"},
                                               {"R", "G", "B"},
                                               {"R", "G", "B", "A"}};
  return components < std::size(byCount) ? byCount[components] : std::vector<std::string>();
}

/// Interleaved samples to planes; integers become [0, 1].
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

void unpackAs(itk::IOComponentEnum type, const std::filesystem::path& path,
              const std::vector<char>& bytes, const std::vector<std::string>& names, Image& image) {
  if (type == itk::IOComponentEnum::UCHAR)
    unpack<std::uint8_t>(bytes, names, image);
  else if (type == itk::IOComponentEnum::USHORT)
    unpack<std::uint16_t>(bytes, names, image);
  else if (type == itk::IOComponentEnum::FLOAT)
    unpack<float>(bytes, names, image);
  else
    throw inputError(path.string(), "has samples of type " +
                                        itk::ImageIOBase::GetComponentTypeAsString(type) +
                                        "; store 8 or 16 bit, or 32-bit float");
}

/// Its further axes, if any, hold one slice.
bool isOnePicture(const itk::ImageIOBase& io) {
  bool one = io.GetNumberOfDimensions() >= 2;
  for (unsigned axis = 2; axis < io.GetNumberOfDimensions(); ++axis)
    one = one && io.GetDimensions(axis) == 1;
  return one;
}

Image readThroughItk(const std::filesystem::path& path, ImageFormat format) {
  if (format == ImageFormat::nrrd)
    checkAttached(path);
  const auto io = itkImageIo(format);
  io->SetFileName(path.string());
  io->ReadImageInformation();
  const auto names = channelNames(format, io->GetNumberOfComponents());
  if (!isOnePicture(*io) || names.empty())
    throw inputError(path.string(), "is not one picture of 1 to 4 components; extract one");
  checkSize(path, static_cast<std::int64_t>(io->GetDimensions(0)),
            static_cast<std::int64_t>(io->GetDimensions(1)), io->GetNumberOfComponents());
  itk::ImageIORegion region(io->GetNumberOfDimensions());
  for (unsigned axis = 0; axis < io->GetNumberOfDimensions(); ++axis)
    region.SetSize(axis, io->GetDimensions(axis));
  io->SetIORegion(region);
  Image image;
  image.width = static_cast<int>(io->GetDimensions(0));
  image.height = static_cast<int>(io->GetDimensions(1));
  std::vector<char> bytes(static_cast<std::size_t>(io->GetImageSizeInBytes()));
  io->Read(bytes.data());
  unpackAs(io->GetComponentType(), path, bytes, names, image);
  return image;
}

} // namespace

Image readImage(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    throw inputError(path.string(), "is not a file that can be read; name an image");
  const auto format = imageFormat(path);
  if (!format)
    throw inputError(path.string(),
                     std::string("has no known extension; name an image ") + imageExtensions);
  try {
    return *format == ImageFormat::exr ? readExr(path) : readThroughItk(path, *format);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw inputError(path.string(), "does not fit into memory; use a smaller image");
  } catch (const std::exception& error) {
    // ITK's text names its own source lines; OpenEXR's says what is wrong.
    const std::string detail = *format == ImageFormat::exr ? " (" + firstLine(error) + ")" : "";
    throw inputError(path.string(),
                     "is damaged or not of its extension's format" + detail + "; write it again");
  }
}

} // namespace fenestra
