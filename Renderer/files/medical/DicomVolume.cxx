// Assembles a volume from the slices of a DICOM series.

#include "base/Distribution.h"
#include "base/Error.h"
#include "files/medical/DicomReader.h"
#include "files/medical/DicomSeries.h"
#include "files/medical/HounsfieldOffset.h"
#include "files/medical/VolumeReader.h"

namespace fenestra {
namespace {

using Path = std::filesystem::path;

constexpr double maxLength = 1e9; ///< mm, as in the other formats

struct Slice {
  Path path;
  DicomHeader header;
  Vec3 position;      ///< center of the first voxel, LPS mm
  double depth = 0.0; ///< position along the normal, mm
};

std::string formatMm(double length) {
  return toString(length, 4) + " mm";
}

// ---- one file

Slice openSlice(DicomReader& files, const Path& path) {
  const auto header = files.readHeader(path);
  const auto refuse = [&](const char* field, const char* what) {
    throw fieldError(path, field, what);
  };
  if (!header)
    throw inputError(ErrorCode::unsupportedFile, path,
                     "is not a DICOM file; give a volume file or a DICOM series");
  const DicomHeader& h = *header;
  if (!h.isComplete)
    throw inputError(ErrorCode::damagedFile, path,
                     "is damaged, truncated or deflated; export the series again");
  if (!isImage(h))
    refuse("PixelData", "is missing; give a series of images");
  if (h.frames != 1)
    refuse("NumberOfFrames", "multi-frame files are not supported; save the volume in Slicer as "
                             ".nrrd and use that");
  if (h.samples != 1 || h.photometric != "MONOCHROME2")
    refuse("PhotometricInterpretation",
           "is not MONOCHROME2 with one sample per voxel; give a series "
           "of gray images");
  if (h.position.size() != 3 || h.orientation.size() != 6)
    refuse("ImagePositionPatient or ImageOrientationPatient", "is missing, so the slice cannot be "
                                                              "placed; give another series");
  if (h.pixelSpacing.size() != 2)
    refuse("PixelSpacing", "is missing; give another series");
  for (const double spacing : h.pixelSpacing)
    if (!(spacing > 1.0 / maxLength && spacing < maxLength))
      refuse("PixelSpacing", "must be above 0 mm; export the series again");
  checkDicomPixels(path, h);
  return {path, h, {h.position[0], h.position[1], h.position[2]}};
}

// ---- all files

void checkConsistent(const std::vector<Slice>& slices) {
  const Slice& first = slices.front();
  const auto isNear = [](const std::vector<double>& a, const std::vector<double>& b, double error) {
    return std::ranges::equal(a, b, [=](double x, double y) { return std::abs(x - y) <= error; });
  };
  for (const Slice& slice : slices) {
    const auto refuse = [&](const char* field) {
      throw fieldError(slice.path, field, "differs from that of ", first.path.filename(),
                       "; give a series of parallel slices of equal size");
    };
    const DicomHeader& h = slice.header;
    if (h.rows != first.header.rows || h.columns != first.header.columns)
      refuse("Rows or Columns");
    if (!isNear(h.orientation, first.header.orientation, 1e-3))
      refuse("ImageOrientationPatient");
    if (!isNear(h.pixelSpacing, first.header.pixelSpacing, 1e-3 * first.header.pixelSpacing[0]))
      refuse("PixelSpacing");
  }
}

/// Throws Error (input) if one of the sorted slices is missing or duplicated.
void checkGaps(const std::vector<Slice>& slices) {
  std::vector<double> gaps;
  for (std::size_t i = 1; i < slices.size(); ++i)
    gaps.push_back(slices[i].depth - slices[i - 1].depth);
  const double medianGap = findMedian(std::vector(gaps));
  constexpr double minGap = 1e-3; // mm
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const std::string nextName = slices[i + 1].path.filename().string();
    if (gaps[i] < minGap)
      throw fieldError(slices[i].path, "ImagePositionPatient", "equals that of ", nextName,
                       "; give a series with one slice per position (no multiple times or echoes)");
    if (std::abs(gaps[i] - medianGap) > 0.5 * medianGap)
      throw fieldError(slices[i].path, "ImagePositionPatient", "is ", formatMm(gaps[i]), " from ",
                       nextName, ", but the median gap is ", formatMm(medianGap),
                       "; add the missing slices");
  }
}

/// Step from one slice to the next, LPS mm. Warns about uneven slices of the volume `name`.
Vec3 computeStep(const std::vector<Slice>& slices, const DicomAxes& axes, const std::string& name,
                 std::vector<Message>& warnings) {
  if (slices.size() == 1)
    return axes.normal();
  checkGaps(slices);
  Vec3 step =
      (slices.back().position - slices.front().position) / static_cast<double>(slices.size() - 1);
  const std::vector<double>& pixel = slices.front().header.pixelSpacing;
  double maxOffset = 0.0;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    const Vec3 offset = slices[i].position - slices.front().position - double(i) * step;
    const double normalOffset = std::abs(offset.dot(axes.normal()));
    if (normalOffset > 0.5 * step.dot(axes.normal()) ||
        std::abs(offset.dot(axes.row)) > 0.5 * pixel[1] ||
        std::abs(offset.dot(axes.column)) > 0.5 * pixel[0])
      throw fieldError(slices[i].path, "ImagePositionPatient", "is ", formatMm(offset.norm()),
                       " off even spacing; resample the series in Slicer and use the volume file");
    maxOffset = std::max(maxOffset, offset.norm());
  }
  if (maxOffset > 0.02 * step.norm())
    warnings.push_back(makeMessage(ErrorCode::assumedGeometry, name, "slices are up to ",
                                   formatMm(maxOffset), " off even spacing; ",
                                   formatMm(step.norm()), " steps are used"));
  return step;
}

Grid makeGrid(const std::vector<Slice>& slices, const DicomAxes& axes, const Vec3& step) {
  const DicomHeader& h = slices.front().header;
  for (const Slice& slice : slices)
    if (!(slice.position.array().abs() < maxLength).all())
      throw fieldError(slice.path, "ImagePositionPatient",
                       "must be within 1e9 mm of the origin; export the series again");
  const Mat3 steps(axes.row * h.pixelSpacing[1], axes.column * h.pixelSpacing[0], step);
  return {Size3(h.columns, h.rows, static_cast<std::int64_t>(slices.size())),
          Affine(lpsToRas * steps, lpsToRas * slices.front().position)};
}

VoxelStore readAll(DicomReader& files, const std::vector<Slice>& slices) {
  const DicomHeader& first = slices.front().header;
  VoxelStore all(std::size_t{first.rows} * first.columns * slices.size());
  for (const Slice& slice : slices) {
    const auto scalars = rescaleVoxels(slice.header, files.readVoxels(slice.path, slice.header));
    const std::span block(scalars);
    all.append(block, computeStats(block));
  }
  return all;
}

/// True for a CT whose header states no rescaling.
bool isUnscaledCt(const std::vector<Slice>& slices) {
  return std::ranges::all_of(slices, [](const Slice& slice) {
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
  return text == "US" ? std::optional(Modality::us) : std::nullopt;
}

Volume readSlices(const std::vector<Path>& paths, const std::string& name,
                  const VolumeChoice& choice) {
  DicomReader files;
  std::vector<Slice> slices;
  for (const Path& path : paths)
    slices.push_back(openSlice(files, path));
  if (slices.empty())
    throw inputError(ErrorCode::missingFile, name,
                     "names no DICOM file; give the files of the series");
  checkConsistent(slices);
  const DicomAxes axes = parseAxes(slices.front().header.orientation, slices.front().path.string());
  for (Slice& slice : slices)
    slice.depth = slice.position.dot(axes.normal());
  std::ranges::stable_sort(slices, {}, &Slice::depth);
  std::vector<Message> warnings;
  chooseFrame(name, choice.frame, 1, warnings);
  const Grid grid = makeGrid(slices, axes, computeStep(slices, axes, name, warnings));
  Volume volume = makeVolume(name, grid, readAll(files, slices));
  std::ranges::move(warnings, std::back_inserter(volume.warnings));
  const DicomHeader& header = slices.front().header;
  volume.modality = parseModality(header.modality);
  volume.hasContrastAgent = !trim(header.contrastAgent).empty();
  if (isUnscaledCt(slices))
    correctHounsfieldOffset(volume);
  return volume;
}

} // namespace

Volume readDicomVolume(const std::vector<Path>& files, const std::string& name,
                       const VolumeChoice& choice) {
  try {
    return readSlices(files, name, choice);
  } catch (const std::bad_alloc&) {
    throw inputError(ErrorCode::outOfMemory, name, "does not fit into memory; crop or resample it");
  }
}

Volume readDicomVolume(const DicomSeries& series, const VolumeChoice& choice) {
  return readDicomVolume(series.files, series.files.front().parent_path().string(), choice);
}

} // namespace fenestra
