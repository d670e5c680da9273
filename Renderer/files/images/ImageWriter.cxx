#include "files/images/ImageWriter.h"

#include "base/Error.h"
#include "base/TextStream.h"
#include "files/formats/NrrdWriter.h"
#include "files/images/ImageFormat.h"

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <png.h>
#include <tiffio.hxx>
#include <zlib.h>

#include <cstdint>
#include <fstream>
#include <limits>
#include <memory>
#include <new>

namespace fenestra::core {

namespace {

/// Throws std::bad_alloc for an incomplete EXR. OpenEXR swallows allocation failures in its tasks
/// and destructors.
void requireComplete(const std::string& exr) {
  Imf::StdISStream stream;
  stream.str(exr);
  if (!Imf::InputFile(stream).isComplete())
    throw std::bad_alloc();
}

std::string encodeExr(const Image& image) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = 1;                      // noise barely compresses
  Imf::addChromaticities(header, Imf::Chromaticities()); // Rec. 709
  for (const auto& [key, value] : image.header)
    header.insert("fenestra." + key, Imf::StringAttribute(value));
  // sealProvenanceTag replaces the blank tag by one with a checksum.
  header.insert("software", Imf::StringAttribute(std::string(blankProvenanceTag)));
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
  std::string bytes = stream.str();
  requireComplete(bytes);
  return sealProvenanceTag(std::move(bytes));
}

bool isOpaque(const std::vector<float>& rgba) {
  for (std::size_t i = 3; i < rgba.size(); i += 4)
    if (rgba[i] < 1.0f)
      return false;
  return true;
}

/// Scales a value in [0, 1] to the full range of T.
template <typename T>
T quantize(float value) {
  return static_cast<T>(std::lround(static_cast<double>(value) * std::numeric_limits<T>::max()));
}

/// Quantizes interleaved RGBA; drops alpha if all pixels are opaque.
template <typename T>
std::vector<T> quantizePixels(const std::vector<float>& rgba) {
  const bool opaque = isOpaque(rgba);
  std::vector<T> values;
  values.reserve(rgba.size());
  for (std::size_t i = 0; i < rgba.size(); ++i)
    if (!opaque || i % 4 != 3)
      values.push_back(quantize<T>(rgba[i]));
  return values;
}

std::string toBigEndian(std::uint32_t number) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0})
    bytes += static_cast<char>(number >> shift & 0xff);
  return bytes;
}

/// A tEXt chunk (PNG specification, 11.3.4.3), which libpng's simplified interface cannot write.
/// setChecksum fills in its checksum.
std::string makeTextChunk(const std::string& keyword, std::string_view text) {
  const auto length = static_cast<std::uint32_t>(keyword.size() + 1 + text.size());
  return toBigEndian(length) + "tEXt" + keyword + std::string(1, '\0') + std::string(text) +
         toBigEndian(0);
}

/// Sets the checksum of the chunk of `size` bytes at `start`. A chunk is 4 bytes of length, type
/// and data, which the checksum covers, and 4 bytes of checksum.
void setChecksum(std::string& png, std::size_t start, std::size_t size) {
  const auto* const bytes = reinterpret_cast<const Bytef*>(png.data()) + start + 4;
  const uLong checksum = crc32(crc32(0, nullptr, 0), bytes, static_cast<uInt>(size - 8));
  png.replace(start + size - 4, 4, toBigEndian(static_cast<std::uint32_t>(checksum)));
}

/// Inserts the provenance tag and, unless empty, the comment after the first chunk, IHDR.
std::string insertTexts(std::string png, const std::string& comment) {
  constexpr std::size_t afterHeader = 8 + 25; // signature and IHDR
  if (!comment.empty()) {
    const std::string chunk = makeTextChunk("Comment", comment);
    png.insert(afterHeader, chunk);
    setChecksum(png, afterHeader, chunk.size());
  }
  const std::string tag = makeTextChunk("Software", blankProvenanceTag);
  png.insert(afterHeader, tag);
  png = sealProvenanceTag(std::move(png));
  setChecksum(png, afterHeader, tag.size());
  return png;
}

/// Comment of a display image: tone and exposure, and the header's descriptions of denoiser and
/// volume; empty: neither.
std::string makeComment(const Image& image, const Display& display) {
  std::string comment;
  if (display.view != DisplayView::standard)
    comment =
        concat("tone ", toString(display.view), ", exposure ", toString(display.exposure), " EV");
  for (const auto& [key, prefix] : {std::pair("filter", ""), std::pair("volume", "volume ")})
    if (const auto found = image.header.find(key); found != image.header.end())
      comment += concat(comment.empty() ? "" : "; ", prefix, found->second);
  return comment;
}

std::string encodePngPixels(const Image& image, const std::vector<float>& rgba,
                            const std::string& comment) {
  const std::vector<std::uint8_t> values = quantizePixels<std::uint8_t>(rgba);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = isOpaque(rgba) ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  png.flags = PNG_IMAGE_FLAG_FAST; // twice the work barely compresses noise better
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string content(size, '\0');
  if (!png_image_write_to_memory(&png, content.data(), &size, 0, values.data(), 0, nullptr))
    throw outputError("image as PNG", png.message, "; write it as .exr");
  content.resize(size);
  return insertTexts(std::move(content), comment);
}

void setTiffFields(TIFF* tiff, const Image& image, bool opaque, const std::string& comment) {
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
  if (!comment.empty())
    TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, comment.c_str());
  TIFFSetField(tiff, TIFFTAG_SOFTWARE, std::string(blankProvenanceTag).c_str());
}

std::string encodeTiff(const Image& image, const std::vector<float>& rgba,
                       const std::string& comment) {
  std::vector<std::uint16_t> values = quantizePixels<std::uint16_t>(rgba);
  const std::size_t rowLength = values.size() / static_cast<std::size_t>(image.height);
  TextWriter stream;
  const std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(TIFFStreamOpen("image", &stream), TIFFClose);
  bool good = tiff != nullptr;
  if (good)
    setTiffFields(tiff.get(), image, isOpaque(rgba), comment);
  for (std::size_t row = 0; good && row < static_cast<std::size_t>(image.height); ++row)
    good = TIFFWriteScanline(tiff.get(), &values[row * rowLength],
                             static_cast<std::uint32_t>(row)) == 1;
  if (!good || TIFFFlush(tiff.get()) != 1)
    throw outputError(ErrorCode::outOfMemory, "image as TIFF",
                      "does not fit into memory; write it as .exr");
  return sealProvenanceTag(stream.str());
}

/// Index-to-world transform of the slice; its thickness equals the pixel width. It is right-handed,
/// so that Slicer need not flip it.
Affine makeSliceToWorld(const ImagePlane& plane) {
  const Vec3 normal = plane.columnStep.cross(plane.rowStep).normalized();
  return Affine({plane.columnStep, plane.rowStep, normal * plane.columnStep.norm()}, plane.topLeft);
}

/// `values`: one or more floats per pixel.
/// `keys`: entries of the image's header to write, if present.
std::string encodeSlice(const Image& image, const ImagePlane& plane,
                        const std::vector<float>& values,
                        std::initializer_list<const char*> keys = {"volume"}) {
  const std::size_t components = values.size() / image.channels.at("R").size();
  NrrdFields fields = {{"Software", std::string(blankProvenanceTag)}};
  for (const char* key : keys)
    if (const auto entry = image.header.find(key); entry != image.header.end())
      fields.emplace_back(*entry);
  const NrrdHeader header{.type = "float",
                          .leadingKind = components > 1 ? "vector" : "",
                          .leadingCount = components,
                          .size = {image.width, image.height, 1},
                          .indexToWorld = makeSliceToWorld(plane),
                          .encoding = NrrdHeader::Encoding::raw,
                          .fields = std::move(fields)};
  return sealProvenanceTag(encodeNrrd(header, asBytes(values)));
}

/// Path of an extra file beside a `.nrrd`.
std::filesystem::path makeSiblingPath(const std::filesystem::path& path, const char* part) {
  return path.parent_path() / (path.stem().string() + "-" + part + ".nrrd");
}

/// Geometry lines of a NRRD header: space, directions, origin.
std::vector<std::string> readGridLines(const std::filesystem::path& path) {
  std::vector<std::string> lines;
  ThrowingStream<std::ifstream> file(path, std::ios::binary);
  // "none" is the axis of the color components, which the depth lacks.
  for (std::string line; std::getline(file, line) && !line.empty() && lines.size() < 3;)
    for (const char* field : {"space: ", "space directions: ", "space origin: "})
      if (line.starts_with(field))
        lines.push_back(line.starts_with("space directions: none ") ? line.erase(18, 5) : line);
  return lines;
}

/// True if Fenestra wrote the depth file. Files older than provenance tags are recognized by their
/// grid, which equals the color file's.
bool isFenestraDepth(const std::filesystem::path& depth, const std::filesystem::path& color) {
  const std::vector<std::string> lines = readGridLines(depth);
  return hasProvenanceTag(depth) || (lines.size() == 3 && lines == readGridLines(color));
}

ImageFormat requireFormat(const std::filesystem::path& path) {
  if (const auto format = findImageFormat(path))
    return *format;
  throw requestError(ErrorCode::unsupportedFile, path, "has an unknown extension; give a file ",
                     imageExtensions);
}

void requireColor(const Image& image, const std::filesystem::path& path) {
  for (const char* name : {"R", "G", "B"})
    if (!image.find(name))
      throw requestError(ErrorCode::unsupportedFile, path, "the image has no channel ", name,
                         "; write it as .exr");
}

} // namespace

std::vector<float> interleaveRgba(const Image& image, const std::string& prefix) {
  const std::size_t count = image.channels.at(prefix + "R").size();
  std::vector<float> values(4 * count, 1.0f);
  for (std::size_t c = 0; c < 4; ++c)
    if (const std::vector<float>* channel = image.find(prefix + "RGBA"[c]))
      for (std::size_t i = 0; i < count; ++i)
        values[4 * i + c] = (*channel)[i];
  return values;
}

std::vector<std::uint8_t> makeDisplayBytes(const Image& image, const ImagePlane& plane,
                                           const Display& display) {
  const std::vector<float> pixels = makeDisplayPixels(image, plane, display);
  std::vector<std::uint8_t> bytes(pixels.size());
  std::ranges::transform(pixels, bytes.begin(), quantize<std::uint8_t>);
  return bytes;
}

std::vector<float> makeDisplayPixels(const Image& image, const ImagePlane& plane,
                                     const Display& display) {
  std::vector<float> pixels = toDisplay(interleaveRgba(image), display);
  drawAnnotations(display.annotations, plane, image.width, image.height, pixels);
  return pixels;
}

std::string encodePng(const Image& image, const ImagePlane& plane, const Display& display) {
  return encodePngPixels(image, makeDisplayPixels(image, plane, display),
                         makeComment(image, display));
}

void writeImage(const Image& image, const ImagePlane& plane, const std::filesystem::path& path,
                Outputs& outputs, const Display& display) {
  const ImageFormat format = requireFormat(path);
  if (format == ImageFormat::exr)
    return outputs.write(path, encodeExr(image));
  requireColor(image, path);
  if (format == ImageFormat::nrrd) {
    outputs.write(path, encodeSlice(image, plane, interleaveRgba(image)));
    for (const char* depth : {"Z", "depth50"})
      if (const std::vector<float>* values = image.find(depth))
        outputs.write(makeSiblingPath(path, depth),
                      encodeSlice(image, plane, *values, {"volume", "camera"}));
    if (image.find("denoised.R"))
      outputs.write(makeSiblingPath(path, "denoised"),
                    encodeSlice(image, plane, interleaveRgba(image, "denoised.")));
    return;
  }
  if (format == ImageFormat::png)
    return outputs.write(path, encodePng(image, plane, display));
  outputs.write(path, encodeTiff(image, makeDisplayPixels(image, plane, display),
                                 makeComment(image, display)));
}

std::vector<std::filesystem::path> listImageFiles(const std::filesystem::path& path) {
  if (requireFormat(path) == ImageFormat::nrrd)
    return {path, makeSiblingPath(path, "Z"), makeSiblingPath(path, "denoised"),
            makeSiblingPath(path, "depth50")};
  return {path};
}

void declareImage(const std::filesystem::path& path, Outputs& outputs, NameOrigin origin,
                  const ExtraFiles& extra) {
  const ImageFormat format = requireFormat(path);
  if (origin == NameOrigin::user)
    outputs.add(path);
  else
    outputs.add(path, hasProvenanceTag); // replaces only a file for which this is true
  if (format != ImageFormat::nrrd)
    return;
  outputs.add(makeSiblingPath(path, "Z"),
              [path](const auto& depth) { return isFenestraDepth(depth, path); });
  if (extra.denoised)
    outputs.add(makeSiblingPath(path, "denoised"), hasProvenanceTag);
  if (extra.depth50)
    outputs.add(makeSiblingPath(path, "depth50"), hasProvenanceTag);
}

} // namespace fenestra::core
