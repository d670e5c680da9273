#include "io/medical/MedicalImage.h"

#include "core/Error.h"
#include "io/InputFile.h"
#include "io/medical/MedicalHeader.h"
#include "io/medical/NiftiSamples.h"
#include "io/medical/Quiet.h"

#include <itkMetaDataObject.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

namespace fenestra {
namespace {

itk::ImageIOBase::Pointer makeImageIo(MedicalFormat format) {
  switch (format) {
  case MedicalFormat::nrrd:
    return itk::NrrdImageIO::New().GetPointer();
  case MedicalFormat::nifti:
    return itk::NiftiImageIO::New().GetPointer();
  case MedicalFormat::metaImage:
    break;
  }
  return itk::MetaImageIO::New().GetPointer();
}

void checkPixels(const std::filesystem::path& path, const itk::ImageIOBase& io,
                 Components allowed) {
  using Pixel = itk::IOPixelEnum;
  const Pixel type = io.GetPixelType();
  const bool scalar = io.GetNumberOfComponents() == 1 && type != Pixel::COMPLEX;
  const bool list = allowed == Components::any && type == Pixel::VECTOR;
  if (!scalar && !list)
    throw inputError(path.string(), "has " + std::to_string(io.GetNumberOfComponents()) +
                                        " components a voxel (" +
                                        itk::ImageIOBase::GetPixelTypeAsString(type) +
                                        "); convert it to one scalar a voxel");
}

std::size_t framesOf(const itk::ImageIOBase& io) {
  return io.GetNumberOfDimensions() > 3 ? io.GetDimensions(3) : 1;
}

/// The number of axes that matter is three; a fourth may hold several frames where `allowed`.
Size3 sizeOf(const std::filesystem::path& path, const itk::ImageIOBase& io, Components allowed) {
  const unsigned axes = io.GetNumberOfDimensions();
  if (axes < 3)
    throw inputError(path.string(), "is a picture of " + std::to_string(axes) +
                                        " axes, not a volume; name one of three");
  const bool frames = allowed == Components::any && io.GetNumberOfComponents() == 1;
  for (unsigned axis = frames ? 4 : 3; axis < axes; ++axis)
    if (io.GetDimensions(axis) != 1)
      throw inputError(path.string(), "has " + std::to_string(axes) + " axes, the " +
                                          std::to_string(axis + 1) + "th with " +
                                          std::to_string(io.GetDimensions(axis)) +
                                          " frames; extract one of them");
  Size3 size;
  for (unsigned axis = 0; axis < 3; ++axis) {
    size[axis] = static_cast<std::int64_t>(io.GetDimensions(axis));
    if (size[axis] < 1)
      throw inputError(path.string(), "sizes: axis " + std::to_string(axis + 1) +
                                          " has no voxels; write it again");
  }
  return size;
}

Grid gridOf(const std::filesystem::path& path, const itk::ImageIOBase& io, Components allowed) {
  const Size3 size = sizeOf(path, io, allowed);
  const Eigen::DiagonalMatrix<double, 3> lpsToRas(-1.0, -1.0, 1.0);
  Mat3 directions;
  Vec3 spacing, origin;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const std::vector<double> direction = io.GetDirection(axis);
    directions.col(axis) << direction[0], direction[1], direction[2];
    spacing[axis] = io.GetSpacing(axis);
    origin[axis] = io.GetOrigin(axis);
  }
  constexpr double largest = 1e9; // mm; beyond, a point keeps no fraction of a voxel
  if (!((spacing.array() > 1.0 / largest).all() && (spacing.array() < largest).all()))
    throw inputError(path.string(), "spacing: must be above 0 mm in every axis; mend the header");
  if (!(origin.array().abs() < largest).all())
    throw inputError(path.string(), "origin: is not a place within 1e9 mm; mend the header");
  // The volume of the cell that unit directions span: 1 for orthogonal axes, 0 for coplanar ones.
  constexpr double flattest = 1e-6;
  if (!(std::abs(directions.colwise().normalized().determinant()) > flattest))
    throw inputError(path.string(), "directions: the axes do not span space; mend the header");
  Affine indexToWorld;
  indexToWorld.linear() = lpsToRas * directions * spacing.asDiagonal();
  indexToWorld.translation() = lpsToRas * origin;
  return {size, indexToWorld};
}

/// The greatest number where there are more.
std::uint64_t sampleCount(const itk::ImageIOBase& io) {
  std::uint64_t samples = io.GetNumberOfComponents();
  for (unsigned axis = 0; axis < io.GetNumberOfDimensions(); ++axis)
    if (__builtin_mul_overflow(samples, io.GetDimensions(axis), &samples))
      return UINT64_MAX;
  return samples;
}

/// Refuses more samples than the files can hold.
void checkCount(const std::filesystem::path& path, const StoredSamples& stored,
                const itk::ImageIOBase& io) {
  std::uint64_t declared = 0;
  if (__builtin_mul_overflow(sampleCount(io), io.GetComponentSize(), &declared))
    declared = UINT64_MAX;
  checkCapacity(path, stored, declared);
  if (stored.isStream) // MetaIO takes half a stream for a whole one, teem all but its end
    checkStream(path, stored, declared);
}

template <typename T>
Samples readAs(itk::ImageIOBase& io, std::size_t count) {
  std::vector<T> samples(count);
  io.Read(samples.data());
  return samples;
}

Samples readSamples(const std::filesystem::path& path, itk::ImageIOBase& io, std::size_t count) {
  itk::ImageIORegion region(io.GetNumberOfDimensions());
  for (unsigned axis = 0; axis < io.GetNumberOfDimensions(); ++axis)
    region.SetSize(axis, io.GetDimensions(axis));
  io.SetIORegion(region);
  using Type = itk::IOComponentEnum;
  switch (io.GetComponentType()) {
  case Type::CHAR:
    return readAs<std::int8_t>(io, count);
  case Type::UCHAR:
    return readAs<std::uint8_t>(io, count);
  case Type::SHORT:
    return readAs<std::int16_t>(io, count);
  case Type::USHORT:
    return readAs<std::uint16_t>(io, count);
  case Type::INT:
    return readAs<std::int32_t>(io, count);
  case Type::UINT:
    return readAs<std::uint32_t>(io, count);
  case Type::LONG:
  case Type::LONGLONG:
    return readAs<std::int64_t>(io, count);
  case Type::ULONG:
  case Type::ULONGLONG:
    return readAs<std::uint64_t>(io, count);
  case Type::FLOAT:
    return readAs<float>(io, count);
  case Type::DOUBLE:
    return readAs<double>(io, count);
  default:
    throw inputError(path.string(),
                     "has samples of an unknown type; convert them to 16-bit integers");
  }
}

/// From one frame after the other to the components of a voxel together.
Samples interleaved(const Samples& frames, std::size_t count) {
  return std::visit(
      [count](const auto& samples) -> Samples {
        std::decay_t<decltype(samples)> together(samples.size());
        const std::size_t voxels = samples.size() / count;
        for (std::size_t frame = 0; frame < count; ++frame)
          for (std::size_t voxel = 0; voxel < voxels; ++voxel)
            together[voxel * count + frame] = samples[frame * voxels + voxel];
        return together;
      },
      frames);
}

std::map<std::string, std::string> textFields(const itk::ImageIOBase& io) {
  const itk::MetaDataDictionary& dictionary = io.GetMetaDataDictionary();
  std::map<std::string, std::string> fields;
  for (const std::string& key : dictionary.GetKeys()) {
    std::string text;
    if (itk::ExposeMetaData(dictionary, key, text))
      fields[key] = text;
  }
  return fields;
}

MedicalImage readThroughItk(const std::filesystem::path& path, MedicalFormat format,
                            Components allowed) {
  const StoredSamples stored = locateSamples(path, format); // refuses what ITK does not survive
  if (format == MedicalFormat::nifti)
    checkNiftiHeader(path);
  const Quiet quiet;
  const auto io = makeImageIo(format);
  io->SetFileName(path.string());
  io->ReadImageInformation();
  // Of the formats, NRRD alone keeps a list of layers.
  if (format != MedicalFormat::nrrd)
    allowed = Components::one;
  checkPixels(path, *io, allowed);
  MedicalImage image{.grid = gridOf(path, *io, allowed), .components = io->GetNumberOfComponents()};
  if (format == MedicalFormat::nifti)
    image.samples = readNiftiSamples(path, sampleCount(*io));
  else {
    checkCount(path, stored, *io);
    image.samples = readSamples(path, *io, sampleCount(*io));
  }
  if (framesOf(*io) > 1) {
    image.components = framesOf(*io);
    image.samples = interleaved(image.samples, image.components);
  }
  image.fields = textFields(*io);
  return image;
}

} // namespace

MedicalImage readMedicalImage(const std::filesystem::path& path, Components allowed) {
  requireFile(path, "name a volume file in it");
  const auto format = medicalFormat(path);
  if (!format)
    throw inputError(path.string(), "has no known extension; name a .nrrd, .nhdr, .nii, .nii.gz, "
                                    ".mha or .mhd file");
  try {
    return readThroughItk(path, *format, allowed);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw inputError(path.string(), "does not fit into memory; crop or resample it");
  } catch (const std::exception&) { // ITK's text has many lines and names its own sources
    throw inputError(path.string(),
                     "is damaged, truncated or not of its extension's format; write it again");
  }
}

} // namespace fenestra
