// Assembles a volume from the slices of a DICOM series.

#include "base/Error.h"
#include "files/medical/DicomSeries.h"
#include "files/medical/DicomSpacing.h"
#include "files/medical/HounsfieldOffset.h"
#include "files/medical/StandardUptake.h"
#include "files/medical/VolumeReader.h"

#include <algorithm>
#include <array>
#include <memory>

namespace fenestra::core {
namespace {

using Path = std::filesystem::path;

constexpr double maxLength = 1e9; ///< mm, as in the other formats

/// True for an image that Siemens composes of the slices of a volume.
bool isMosaic(const DicomHeader& h) {
  const std::vector<std::string> words = split(h.imageType, '\\');
  return std::ranges::find(words, "MOSAIC") != words.end();
}

/// Throws Error (input) unless the slice can be part of a volume.
void checkSlice(const DicomSlice& slice) {
  const DicomHeader& h = slice.header;
  const auto refuse = [&](const char* field, const char* what) {
    throw fieldError(slice.path, field, what);
  };
  if (!h.isComplete)
    throw inputError(ErrorCode::damagedFile, slice.path,
                     "is damaged or truncated; export the series again");
  if (!isImage(h))
    refuse("PixelData", "is missing; give a series of images");
  if (isMosaic(h))
    throw inputError(ErrorCode::unsupportedFile, slice.path,
                     "is a mosaic, which holds many slices side by side; convert the series, for "
                     "example with dcm2niix, and use the volume file");
  if (h.samples != 1 || !h.photometric.starts_with("MONOCHROME"))
    refuse("PhotometricInterpretation",
           "is not MONOCHROME with one sample per voxel; give a series "
           "of gray images");
  if (h.position.size() != 3 || h.orientation.size() != 6)
    refuse("ImagePositionPatient or ImageOrientationPatient", "is missing, so the slice cannot be "
                                                              "placed; give another series");
  parseAxes(h.orientation, slice.path.string());
  if (h.pixelSpacing.size() != 2)
    refuse("PixelSpacing", "is missing; give another series");
  for (const double spacing : h.pixelSpacing)
    if (!(spacing > 1.0 / maxLength && spacing < maxLength))
      refuse("PixelSpacing", "must be above 0 mm; export the series again");
  for (const double x : h.position)
    if (!(std::abs(x) < maxLength))
      refuse("ImagePositionPatient",
             "must be within 1e9 mm of the origin; export the series again");
  checkDicomPixels(slice.path, h);
}

/// Slices of one volume, in the order of their positions.
struct Stack {
  DicomSlices slices;
  DicomAxes axes;
  SliceSpacing spacing;

  const DicomHeader& header() const { return slices.front().header; }
};

/// Requires slices of equal size and orientation.
Stack makeStack(DicomSlices slices, const std::string& name, std::vector<Message>& warnings) {
  for (const DicomSlice& slice : slices)
    checkSlice(slice);
  const DicomAxes axes = *findAxes(slices.front().header.orientation);
  Stack stack{std::move(slices), axes, {}};
  const Vec3 normal = axes.normal();
  std::ranges::stable_sort(stack.slices, {},
                           [&](const DicomSlice& slice) { return getPosition(slice).dot(normal); });
  std::vector<PlacedSlice> placed;
  for (const DicomSlice& slice : stack.slices) {
    const std::string file = slice.path.string();
    placed.push_back({slice.header.frames > 1 ? concat(file, ", frame ", slice.header.frame) : file,
                      getPosition(slice)});
  }
  const std::vector<double>& pixel = stack.header().pixelSpacing;
  stack.spacing =
      computeSpacing(placed, normal, {axes.row, axes.column}, {pixel[1], pixel[0]}, name, warnings);
  if (std::ranges::any_of(stack.slices,
                          [](const DicomSlice& s) { return s.header.isPlacedByThickness; }))
    warnings.push_back(makeMessage(
        ErrorCode::assumedGeometry, name, "states no slice positions; the slice thickness of ",
        toString(stack.spacing.step.norm(), 4), " mm is used as their distance"));
  return stack;
}

Grid makeGrid(const Stack& stack) {
  const DicomHeader& h = stack.header();
  const Mat3 steps(stack.axes.row * h.pixelSpacing[1], stack.axes.column * h.pixelSpacing[0],
                   stack.spacing.step);
  return {Size3(h.columns, h.rows, std::ssize(stack.spacing.slices)),
          Affine(lpsToRas * steps, lpsToRas * getPosition(stack.slices.front()))};
}

using SliceVoxels = std::shared_ptr<const RescaledVoxels>;

/// Rescaled voxels of the slices. The last two are kept, since slices of a volume may need both.
class SliceReader {
public:
  explicit SliceReader(const DicomSlices& slices) : m_slices(slices) {}

  SliceVoxels read(std::size_t i) {
    for (const auto& [slice, voxels] : m_kept)
      if (voxels && slice == i)
        return voxels;
    const auto& [path, header] = m_slices[i];
    m_kept[1] = std::move(m_kept[0]);
    m_kept[0] = {i, std::make_shared<const RescaledVoxels>(
                        rescaleVoxels(header, m_files.readVoxels(path, header)))};
    return m_kept[0].second;
  }

private:
  const DicomSlices& m_slices;
  DicomReader m_files;
  std::array<std::pair<std::size_t, SliceVoxels>, 2> m_kept;
};

/// Interpolated voxels; integers between integers.
RescaledVoxels blend(const RescaledVoxels& lower, const RescaledVoxels& upper, double fraction) {
  const auto isIntegral = [](const auto& voxels) {
    return computeStats(std::span(voxels)).isIntegral;
  };
  const bool rounds = std::visit(isIntegral, lower) && std::visit(isIntegral, upper);
  return std::visit(
      [=](const auto& low, const auto& high) {
        std::vector<double> voxels(low.size());
        std::ranges::transform(low, high, voxels.begin(), [=](double a, double b) {
          const double value = a + fraction * (b - a);
          return rounds ? std::round(value) : value;
        });
        return voxels;
      },
      lower, upper);
}

VoxelStore readAll(const Stack& stack) {
  const DicomHeader& first = stack.header();
  VoxelStore all(std::size_t{first.rows} * first.columns * stack.spacing.slices.size());
  SliceReader reader(stack.slices);
  const auto append = [&](const RescaledVoxels& rescaled) {
    std::visit(
        [&](const auto& voxels) {
          const std::span block(voxels);
          all.append(block, computeStats(block));
        },
        rescaled);
  };
  for (const SliceBlend& slice : stack.spacing.slices) {
    const SliceVoxels lower = reader.read(slice.lower);
    if (slice.lower == slice.upper)
      append(*lower);
    else
      append(blend(*lower, *reader.read(slice.upper), slice.fraction));
  }
  return all;
}

/// True for a CT whose header states no rescaling.
bool isUnscaledCt(const DicomSlices& slices) {
  return std::ranges::all_of(slices, [](const DicomSlice& slice) {
    const DicomHeader& h = slice.header;
    return h.modality == "CT" && h.slope == 1.0 && h.intercept == 0.0;
  });
}

/// Modality of a series; empty: another one.
std::optional<Modality> parseModality(const std::string& text) {
  if (text == "CT")
    return Modality::ct;
  if (text == "MR")
    return Modality::mr;
  if (text == "PT")
    return Modality::pt;
  return text == "US" ? std::optional(Modality::us) : std::nullopt;
}

Volume readFrame(const DicomSeries& series, const std::string& name, const VolumeChoice& choice) {
  std::vector<Message> warnings = series.warnings;
  const std::size_t frame = chooseFrame(name, choice.frame, series.frames.size(), warnings);
  Stack stack = makeStack(series.frames[frame], name, warnings);
  if (stack.header().modality == "PT")
    convertToSuv(stack.slices, series, name, warnings);
  Volume volume = makeVolume(name, makeGrid(stack), readAll(stack));
  volume.frameCount = series.frames.size();
  std::ranges::move(warnings, std::back_inserter(volume.warnings));
  const DicomHeader& header = stack.header();
  volume.modality = parseModality(header.modality);
  volume.hasContrastAgent = !trim(header.contrastAgent).empty();
  if (isUnscaledCt(stack.slices))
    correctHounsfieldOffset(volume);
  return volume;
}

Volume readVolumeOf(const DicomSeries& series, const std::string& name,
                    const VolumeChoice& choice) {
  refuseSpacing(name, choice);
  try {
    return readFrame(series, name, choice);
  } catch (const std::bad_alloc&) {
    throw inputError(ErrorCode::outOfMemory, name, "does not fit into memory; crop or resample it");
  }
}

} // namespace

Volume readDicomVolume(const std::vector<Path>& files, const std::string& name,
                       const VolumeChoice& choice) {
  DicomReader reader;
  DicomSlices slices;
  for (const Path& file : files) {
    const std::vector<DicomHeader> headers = reader.readHeaders(file);
    if (headers.empty())
      throw inputError(ErrorCode::unsupportedFile, file,
                       "is not a DICOM file; give a volume file or a DICOM series");
    for (const DicomHeader& header : headers)
      slices.push_back({file, header});
  }
  if (slices.empty())
    throw inputError(ErrorCode::missingFile, name,
                     "names no DICOM file; give the files of the series");
  const std::vector<DicomSeries> volumes = splitSeries(std::move(slices), name);
  if (volumes.size() > 1)
    throw inputError(name, "names DICOM files of ", volumes.size(), " volumes (",
                     join(volumes, ", ", [](const DicomSeries& volume) { return volume.part; }),
                     "); give those of one");
  return readVolumeOf(volumes.front(), name, choice);
}

Volume readDicomVolume(const DicomSeries& series, const VolumeChoice& choice) {
  const std::vector<Path> files = series.files();
  const Path& first = files.front();
  return readVolumeOf(series, (files.size() == 1 ? first : first.parent_path()).string(), choice);
}

} // namespace fenestra::core
