#include "files/medical/MedicalImage.h"

#include "base/Error.h"
#include "files/medical/FrameSource.h"
#include "files/medical/MedicalHeader.h"
#include "files/medical/NiftiSamples.h"
#include "files/medical/NrrdFrames.h"
#include "files/medical/SampleStream.h"
#include "files/medical/SuppressItkOutput.h"
#include "files/medical/VtkImage.h"
#include "io/InputRegistry.h"

#include <itkMetaDataObject.h>
#include <itkMetaImageIO.h>
#include <itkNrrdImageIO.h>

#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>

namespace fenestra::core {
namespace {

itk::ImageIOBase::Pointer makeImageIo(MedicalFormat format) {
  if (format == MedicalFormat::nrrd)
    return itk::NrrdImageIO::New().GetPointer();
  return itk::MetaImageIO::New().GetPointer();
}

/// `hasList`: the components are a list of frames, and one of them may be read.
void checkPixels(const std::filesystem::path& path, const itk::ImageIOBase& io, Components allowed,
                 bool hasList) {
  using Pixel = itk::IOPixelEnum;
  const Pixel type = io.GetPixelType();
  if (type == Pixel::COMPLEX)
    throw inputError(ErrorCode::unsupportedFile, path,
                     "has complex numbers; save their magnitude as a volume");
  if (type == Pixel::RGB || type == Pixel::RGBA)
    throw inputError(ErrorCode::unsupportedFile, path,
                     "is a color image; convert it to one scalar per voxel");
  const bool isList = type == Pixel::VECTOR && (allowed == Components::any || hasList);
  if (io.GetNumberOfComponents() != 1 && !isList)
    throw inputError(ErrorCode::unsupportedFile, path, "has ", io.GetNumberOfComponents(),
                     " components per voxel (", itk::ImageIOBase::GetPixelTypeAsString(type),
                     "); convert it to one scalar per voxel");
}

std::size_t countFrames(const itk::ImageIOBase& io) {
  return io.GetNumberOfDimensions() > 3 ? io.GetDimensions(3) : 1;
}

/// Size along three axes; a fourth axis may hold frames if `allowed`.
Size3 readSize(const std::filesystem::path& path, const itk::ImageIOBase& io, Components allowed) {
  const unsigned axes = io.GetNumberOfDimensions();
  if (axes < 3)
    throw inputError(ErrorCode::unsupportedFile, path, "is an image of ", axes,
                     " axes, not a volume; give one with three");
  const bool allowsFrames = allowed != Components::one && io.GetNumberOfComponents() == 1;
  for (unsigned axis = allowsFrames ? 4 : 3; axis < axes; ++axis)
    if (io.GetDimensions(axis) != 1)
      throw inputError(ErrorCode::unsupportedFile, path, "has ", axes, " axes, the ", axis + 1,
                       "th with ", io.GetDimensions(axis), " frames; extract one of them");
  Size3 size;
  for (unsigned axis = 0; axis < 3; ++axis) {
    size[axis] = static_cast<std::int64_t>(io.GetDimensions(axis));
    if (size[axis] < 1)
      throw fieldError(path, "sizes", "axis ", axis + 1, " has no voxels; write it again");
  }
  return size;
}

void checkGeometry(const std::filesystem::path& path, const Mat3& directions, const Vec3& spacing,
                   const Vec3& origin) {
  constexpr double maxLength = 1e9; // mm; beyond it, coordinates lose fractions of a voxel
  if (!((spacing.array() > 1.0 / maxLength).all() && (spacing.array() < maxLength).all()))
    throw fieldError(path, "spacing",
                     "must be from 1e-9 to 1e9 mm along every axis; fix the header");
  if (!(origin.array().abs() < maxLength).all())
    throw fieldError(path, "origin", "must be within 1e9 mm; fix the header");
  // The determinant of the unit directions: 1 for orthogonal axes, 0 for coplanar ones.
  constexpr double minDeterminant = 1e-6;
  if (!(std::abs(directions.normalizedColumns().determinant()) > minDeterminant))
    throw fieldError(path, "directions", "the axes are linearly dependent; fix the header");
}

/// `chosen`: spacing of a file that states none; empty: ITK's.
Grid readGrid(const std::filesystem::path& path, const itk::ImageIOBase& io, Components allowed,
              const std::optional<Vec3>& chosen) {
  const Size3 size = readSize(path, io, allowed);
  Mat3 directions;
  Vec3 spacing, origin;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const std::vector<double> direction = io.GetDirection(axis);
    directions.col(static_cast<int>(axis)) = {direction[0], direction[1], direction[2]};
    spacing[static_cast<int>(axis)] =
        chosen ? (*chosen)[static_cast<int>(axis)] : io.GetSpacing(axis);
    origin[static_cast<int>(axis)] = io.GetOrigin(axis);
  }
  checkGeometry(path, directions, spacing, origin);
  return {size, Affine(lpsToRas * directions * Mat3::Diagonal(spacing), lpsToRas * origin)};
}

/// Number of samples; UINT64_MAX: overflow.
std::uint64_t countSamples(const itk::ImageIOBase& io) {
  std::uint64_t samples = io.GetNumberOfComponents();
  for (unsigned axis = 0; axis < io.GetNumberOfDimensions(); ++axis)
    if (__builtin_mul_overflow(samples, io.GetDimensions(axis), &samples))
      return UINT64_MAX;
  return samples;
}

SampleType findSampleType(const std::filesystem::path& path, const itk::ImageIOBase& io) {
  using Type = itk::IOComponentEnum;
  static const std::map<Type, SampleType> types = {
      {Type::CHAR, std::int8_t()},      {Type::UCHAR, std::uint8_t()},
      {Type::SHORT, std::int16_t()},    {Type::USHORT, std::uint16_t()},
      {Type::INT, std::int32_t()},      {Type::UINT, std::uint32_t()},
      {Type::LONG, std::int64_t()},     {Type::ULONG, std::uint64_t()},
      {Type::LONGLONG, std::int64_t()}, {Type::ULONGLONG, std::uint64_t()},
      {Type::FLOAT, float()},           {Type::DOUBLE, double()}};
  const auto type = types.find(io.GetComponentType());
  if (type == types.end())
    throw inputError(ErrorCode::unsupportedFile, path,
                     "has an unsupported sample type; convert it to 16-bit integers");
  return type->second;
}

/// Reads all samples at once, for any encoding that ITK supports.
std::function<void(void*, std::size_t)> readThroughItk(itk::ImageIOBase& io, std::size_t bytes) {
  itk::ImageIORegion region(io.GetNumberOfDimensions());
  for (unsigned axis = 0; axis < io.GetNumberOfDimensions(); ++axis)
    region.SetSize(axis, io.GetDimensions(axis));
  io.SetIORegion(region);
  const std::shared_ptr<char[]> all(new char[bytes]);
  io.Read(all.get());
  return [all, position = std::size_t{0}](void* to, std::size_t part) mutable {
    std::memcpy(to, all.get() + position, part);
    position += part;
  };
}

/// Source of the file's samples, or of one of its `frames`. Throws Error (input) if it declares
/// more than it can hold.
SampleSource makeSampleSource(const std::filesystem::path& path, const StoredSamples& stored,
                              itk::ImageIOBase& io, FrameChoice frames) {
  SampleSource source{.type = findSampleType(path, io), .count = countSamples(io)};
  const std::size_t sampleBytes = bytesPerSample(source.type);
  const std::uint64_t declared = checkDeclaredBytes(path, stored, source.count, sampleBytes);
  const bool isList = io.GetNumberOfComponents() > 1;
  const bool isInUsedOrder =
      !isList || stored.isListFirst || (frames.count > 1 && stored.isListLast);
  const bool isOrderKnown = sampleBytes == 1 || stored.order;
  if (!((stored.isRaw || stored.isStream) && isInUsedOrder && isOrderKnown)) {
    source.read = readThroughItk(io, declared);
    frames.isInterleaved = isList; // by ITK, however they are stored
    return pickFrame(std::move(source), frames);
  }
  source.isSwapped = sampleBytes > 1 && *stored.order != std::endian::native;
  openStream(path, stored, declared, source);
  frames.isInterleaved = isList && stored.isListFirst;
  return pickFrame(std::move(source), frames);
}

std::map<std::string, std::string> readTextFields(const itk::ImageIOBase& io) {
  const itk::MetaDataDictionary& dictionary = io.GetMetaDataDictionary();
  std::map<std::string, std::string> fields;
  for (const std::string& key : dictionary.GetKeys()) {
    std::string text;
    if (itk::ExposeMetaData(dictionary, key, text))
      fields[key] = text;
  }
  return fields;
}

/// Number of samples of an image with these sizes. Throws Error (input) if no file can hold them.
std::size_t multiplySizes(const std::filesystem::path& path,
                          const std::vector<std::int64_t>& sizes) {
  constexpr std::int64_t most = std::int64_t{1} << 48;
  std::int64_t samples = 1;
  for (const std::int64_t size : sizes)
    if (__builtin_mul_overflow(samples, size, &samples) || samples > most)
      throw inputError(ErrorCode::damagedFile, path,
                       "declares more than 2^48 samples; copy or write it again");
  return static_cast<std::size_t>(samples);
}

/// Reads a NIfTI, Analyze or FreeSurfer volume; only NRRD can hold a list of components.
void readNifti(const std::filesystem::path& path, const StoredSamples& stored,
               const NiftiHeader& header, Components allowed, const SampleConsumer& consume,
               const VolumeChoice& choice) {
  refuseSpacing(path.string(), choice);
  const std::size_t axes = header.size.size();
  if (axes < 3)
    throw inputError(ErrorCode::unsupportedFile, path, "is an image of ", axes,
                     " axes, not a volume; give one with three");
  const bool hasFrames = allowed == Components::oneFrame && axes > 3;
  for (std::size_t axis = hasFrames ? 4 : 3; axis < axes; ++axis)
    if (header.size[axis] != 1) { // the fifth axis holds vector components (nifti1.h)
      const char* const problem = axis == 4 ? " components per voxel; convert it to one scalar"
                                            : " frames; extract one of them";
      throw inputError(ErrorCode::unsupportedFile, path, "has ", axes, " axes, the ", axis + 1,
                       "th with ", header.size[axis], problem);
    }
  const Size3 size(header.size[0], header.size[1], header.size[2]);
  const Mat3& axesToRas = header.indexToRas.linear();
  checkGeometry(path, axesToRas, axesToRas.columnNorms(), header.indexToRas.translation());
  MedicalImage image{.grid = {size, header.indexToRas}, .warnings = header.warnings};
  image.extensions = readNiftiExtensions(path, header);
  image.frameCount = hasFrames ? static_cast<std::size_t>(header.size[3]) : 1;
  const FrameChoice frames{
      image.frameCount, chooseFrame(path.string(), choice.frame, image.frameCount, image.warnings)};
  const std::size_t samples = multiplySizes(path, header.size);
  consume(image, pickFrame(openNiftiSamples(path, stored, header, samples), frames));
}

/// Reads a VTK image. Like Slicer, takes its coordinates as LPS.
void readVtk(const std::filesystem::path& path, const SampleConsumer& consume,
             const VolumeChoice& choice) {
  refuseForm(path.string(), choice);
  const VtkImage read = openVtkImage(path, choice.spacing);
  if (read.hasSpacing)
    refuseSpacing(path.string(), choice);
  const Mat3& directions = read.indexToWorld.linear();
  const Vec3& origin = read.indexToWorld.translation();
  checkGeometry(path, directions, directions.columnNorms(), origin);
  MedicalImage image{.grid = {read.size, Affine(lpsToRas * directions, lpsToRas * origin)}};
  image.warnings.push_back(makeMessage(
      ErrorCode::assumedGeometry, path,
      read.hasSpacing || choice.spacing ? "" : "has no spacing: 1 mm is assumed; ",
      "states no anatomical axes: they are assumed toward left, posterior and superior"));
  chooseFrame(path.string(), choice.frame, image.frameCount, image.warnings);
  consume(image, read.samples);
}

/// Warns about what the header leaves open.
void warnAssumptions(const std::filesystem::path& path, bool hasSpacing, bool hasAxes,
                     std::vector<Message>& warnings) {
  if (!hasSpacing || !hasAxes)
    warnings.push_back(makeMessage(
        ErrorCode::assumedGeometry, path, hasSpacing ? "" : "has no spacing: 1 mm is assumed",
        hasSpacing || hasAxes ? "" : "; ",
        hasAxes ? "" : "has no space: axes are assumed toward left, posterior and superior"));
}

/// Reads a NRRD with a time axis that ITK does not support.
void readNrrdFrames(const std::filesystem::path& path, const StoredSamples& stored,
                    const NrrdFrames& read, Components allowed, const SampleConsumer& consume,
                    const VolumeChoice& choice) {
  if (allowed != Components::oneFrame && read.count > 1)
    throw inputError(ErrorCode::unsupportedFile, path, "has ", read.count,
                     " frames; extract one of them");
  const Mat3& directions = read.indexToRas.linear();
  checkGeometry(path, directions, directions.columnNorms(), read.indexToRas.translation());
  MedicalImage image{.grid = {read.size, read.indexToRas}, .frameCount = read.count};
  warnAssumptions(path, stored.hasSpacing || choice.spacing, stored.hasAxes, image.warnings);
  const FrameChoice frame{read.count,
                          chooseFrame(path.string(), choice.frame, read.count, image.warnings),
                          read.isInterleaved};
  consume(image, pickFrame(openNrrdFrames(path, stored, read), frame));
}

void readChecked(const std::filesystem::path& path, MedicalFormat format, Components allowed,
                 const SampleConsumer& consume, const VolumeChoice& choice) {
  if (format == MedicalFormat::vtk)
    return readVtk(path, consume, choice);
  const StoredSamples stored = locateSamples(path, format); // rejects what would crash ITK
  if (format == MedicalFormat::nifti)
    return readNifti(path, stored, readNiftiHeader(path, choice), allowed, consume, choice);
  refuseForm(path.string(), choice);
  if (format == MedicalFormat::mgh)
    return readNifti(path, stored, readMghHeader(path), allowed, consume, choice);
  if (stored.hasSpacing)
    refuseSpacing(path.string(), choice);
  if (format == MedicalFormat::nrrd)
    if (const auto frames = findNrrdFrames(path, choice.spacing);
        frames && (allowed == Components::oneFrame || !frames->hasSpaceTime)) // else: layers
      return readNrrdFrames(path, stored, *frames, allowed, consume, choice);
  const SuppressItkOutput suppress;
  const auto io = makeImageIo(format);
  io->SetFileName(path.string());
  io->ReadImageInformation();
  // Only NRRD can hold a list of segmentation layers.
  if (allowed == Components::any && format != MedicalFormat::nrrd)
    allowed = Components::one;
  checkPixels(path, *io, allowed, allowed == Components::oneFrame && stored.hasList);
  MedicalImage image{.grid = readGrid(path, *io, allowed, choice.spacing),
                     .components = io->GetNumberOfComponents(),
                     .hasFrames = countFrames(*io) > 1,
                     .fields = readTextFields(*io)};
  // The oldest segmentations of Slicer have another convention (SegmentationReader.cxx).
  const bool hasAxes = stored.hasAxes || image.fields.contains("Segmentation_Extent");
  warnAssumptions(path, stored.hasSpacing || choice.spacing, hasAxes, image.warnings);
  if (image.hasFrames)
    image.components = countFrames(*io);
  if (allowed == Components::oneFrame) {
    image.frameCount = std::exchange(image.components, 1);
    image.hasFrames = false;
  }
  const FrameChoice frames{
      image.frameCount, chooseFrame(path.string(), choice.frame, image.frameCount, image.warnings)};
  consume(image, makeSampleSource(path, stored, *io, frames));
}

/// Throws Error (input) for what often lies under the name of an image: it is said what it is.
void rejectMisnamed(const std::filesystem::path& path) {
  std::array<char, 64> bytes{};
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), bytes.size());
  const std::string start = toLower({bytes.data(), static_cast<std::size_t>(file.gcount())});
  if (start.starts_with("version https://git-lfs"))
    throw inputError(ErrorCode::damagedFile, path,
                     "is a pointer of Git LFS, not the file; run: git lfs pull");
  if (const std::string_view text = trim(start);
      text.starts_with("<!doctype html") || text.starts_with("<html"))
    throw inputError(ErrorCode::damagedFile, path,
                     "is a web page, not the file; download the file itself");
  const std::string extension = lowercaseExtension(path);
  if (start.starts_with("\x1f\x8b") && extension != ".gz" && extension != ".mgz")
    throw inputError(ErrorCode::damagedFile, path, "is compressed by gzip; name it ",
                     path.filename().string(), ".gz");
  if (extension == ".gz" && !start.empty() && !start.starts_with("\x1f\x8b"))
    throw inputError(ErrorCode::damagedFile, path, "is not compressed; name it ",
                     path.stem().string());
}

} // namespace

void readMedicalImage(const std::filesystem::path& path, Components allowed,
                      const SampleConsumer& consume, const VolumeChoice& choice) {
  requireFile(path, "give a volume file in it");
  const auto format = findMedicalFormat(path);
  if (lowercaseExtension(path) == ".vtm")
    throw inputError(ErrorCode::segmentationAsVolume, path, "is a segmentation");
  if (!format)
    throw inputError(ErrorCode::unsupportedFile, path,
                     "has an unknown extension; give a .nrrd, .nhdr, .nii, .nii.gz, .hdr, .mgz, "
                     ".mha, .mhd or .vti file, or a folder of slices");
  rejectMisnamed(path);
  try {
    readChecked(path, *format, allowed, consume, choice);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw inputError(ErrorCode::outOfMemory, path, "does not fit into memory; crop or resample it");
  } catch (const std::exception&) { // ITK's text has many lines and names its own sources
    throw inputError(ErrorCode::damagedFile, path,
                     "is damaged, truncated or does not match its extension; write it again");
  }
}

} // namespace fenestra::core
