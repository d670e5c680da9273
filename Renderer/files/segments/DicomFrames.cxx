// Labels of a DICOM segmentation: places its frames on a grid.

#include "files/medical/DicomReader.h"
#include "files/segments/DicomSegments.h"
#include "files/segments/LabelLayers.h"
#include "io/MessageText.h"

#include <algorithm>
#include <map>

namespace fenestra::core {
namespace {

using Path = std::filesystem::path;

constexpr double maxLength = 1e9; ///< mm, as in the other formats
constexpr double maxSlices = 65536.0;
constexpr const char* exportAgain = "export the segmentation again";

struct Place {
  Vec3 position; ///< center of the first pixel, LPS mm
  double depth;  ///< of its plane along the normal, mm
};

/// The grid of all frames, and the plane of each of its slices.
struct Stack {
  Grid grid;
  std::vector<std::size_t> planeOfFrame;
  std::vector<std::vector<std::int64_t>> slicesOfPlane; ///< one, except where planes are uneven
  std::vector<Message> warnings;

  const std::vector<std::int64_t>& slicesOf(std::size_t frame) const {
    return slicesOfPlane[planeOfFrame[frame]];
  }
};

// ---- geometry

/// Throws Error (input) unless all frames state the same orientation and pixel spacing.
void checkFrames(const std::string& source, const DicomSegmentation& object) {
  if (object.frames.empty())
    throw fieldError(source, "PerFrameFunctionalGroupsSequence", "is missing; ", exportAgain);
  const DicomFrame& first = object.frames.front();
  const auto isNear = [](const std::vector<double>& a, const std::vector<double>& b) {
    return std::ranges::equal(a, b, [](double x, double y) { return std::abs(x - y) <= 1e-3; });
  };
  for (const DicomFrame& frame : object.frames) {
    if (frame.position.size() != 3)
      throw fieldError(source, "ImagePositionPatient", "is missing in a frame; ", exportAgain);
    for (const double x : frame.position)
      if (!(std::abs(x) < maxLength))
        throw fieldError(source, "ImagePositionPatient", "must be within 1e9 mm of the origin; ",
                         exportAgain);
    if (!isNear(frame.orientation, first.orientation))
      throw fieldError(source, "ImageOrientationPatient",
                       "differs between frames; export a segmentation with parallel slices");
    if (frame.pixelSpacing != first.pixelSpacing || frame.pixelSpacing.size() != 2)
      throw fieldError(source, "PixelSpacing", "is missing or differs between frames; ",
                       exportAgain);
  }
  for (const double spacing : first.pixelSpacing)
    if (!(spacing > 1.0 / maxLength && spacing < maxLength))
      throw fieldError(source, "PixelSpacing", "must be above 0 mm; ", exportAgain);
}

/// The number of the list if it is the length of a step; else 0.
double toLength(const std::vector<double>& numbers) {
  const bool isLength =
      numbers.size() == 1 && numbers[0] > 1.0 / maxLength && numbers[0] < maxLength;
  return isLength ? numbers[0] : 0.0;
}

/// Distance of the volume's slices along `normal` (RAS) if one of its axes is; else 0.
double findReferenceStep(const Grid* reference, const Vec3& normal) {
  for (int axis = 0; reference && axis < 3; ++axis) {
    const Vec3 step = reference->indexToWorld.linear().col(axis);
    if (std::abs(step.normalized().dot(normal)) > 1.0 - 1e-6)
      return step.norm();
  }
  return 0.0;
}

/// Smallest plane distances that count as different, as a fraction of a step.
constexpr double sameDepth = 0.05;

/// Assigns each frame its plane, in order of depth; returns the planes' depths.
std::vector<double> findPlanes(const std::vector<Place>& places, double tolerance,
                               std::vector<std::size_t>& planeOfFrame) {
  std::vector<std::size_t> order(places.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    order[i] = i;
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return places[i].depth; });
  std::vector<double> depths;
  planeOfFrame.resize(places.size());
  for (const std::size_t i : order) {
    if (depths.empty() || places[i].depth - depths.back() > tolerance)
      depths.push_back(places[i].depth);
    planeOfFrame[i] = depths.size() - 1;
  }
  return depths;
}

/// Number of steps in each gap between planes, rounded; nullopt: a gap is no multiple of `step`.
std::optional<std::vector<std::int64_t>> divideGaps(const std::vector<double>& depths,
                                                    double step) {
  constexpr double maxSteps = 1e15; // exact in double precision
  std::vector<std::int64_t> counts;
  for (std::size_t i = 1; i < depths.size(); ++i) {
    const double steps = (depths[i] - depths[i - 1]) / step, whole = std::round(steps);
    if (!(whole >= 1.0 && whole <= maxSteps && std::abs(steps - whole) <= sameDepth))
      return std::nullopt;
    counts.push_back(static_cast<std::int64_t>(whole));
  }
  return counts;
}

/// Slices of each plane: exactly one if the gaps are multiples of `step`. Else each slice has the
/// nearest plane at up to three quarters of a step, so that an uneven gap is filled, and a missing
/// slice is not. Returns the number of slices.
std::int64_t assignSlices(const std::string& source, const std::vector<double>& depths, double step,
                          std::vector<std::vector<std::int64_t>>& slicesOfPlane) {
  const double steps = std::round((depths.back() - depths.front()) / step);
  if (!(steps < maxSlices))
    throw fieldError(source, "ImagePositionPatient",
                     "puts the frames into more than 65536 slices; ", exportAgain);
  slicesOfPlane.resize(depths.size());
  if (const auto counts = divideGaps(depths, step)) {
    std::int64_t slice = 0;
    slicesOfPlane[0] = {0};
    for (std::size_t gap = 0; gap < counts->size(); ++gap)
      slicesOfPlane[gap + 1] = {slice += (*counts)[gap]};
    return slice + 1;
  }
  const double evenStep = (depths.back() - depths.front()) / steps;
  for (std::int64_t slice = 0; slice <= std::llround(steps); ++slice) {
    const double depth = depths.front() + static_cast<double>(slice) * evenStep;
    const auto after = std::ranges::lower_bound(depths, depth);
    auto nearest = after == depths.end() ? after - 1 : after;
    if (nearest != depths.begin() && depth - *(nearest - 1) < std::abs(*nearest - depth))
      --nearest;
    if (std::abs(*nearest - depth) <= 0.75 * evenStep)
      slicesOfPlane[static_cast<std::size_t>(nearest - depths.begin())].push_back(slice);
  }
  return std::llround(steps) + 1;
}

/// Distance of the slices, as DicomSegments.h states.
double chooseStep(const DicomFrame& frame, const std::vector<double>& depths,
                  double referenceStep) {
  const double stated = toLength(frame.spacingBetweenSlices),
               thickness = toLength(frame.sliceThickness);
  if (depths.size() == 1)
    return stated > 0.0 ? stated : thickness > 0.0 ? thickness : referenceStep;
  const bool isThickness = std::abs(thickness - referenceStep) < sameDepth * referenceStep;
  for (const double step : {stated, isThickness ? referenceStep : 0.0})
    if (step > 0.0 && divideGaps(depths, step))
      return step;
  double least = infinity;
  for (std::size_t i = 1; i < depths.size(); ++i)
    least = std::min(least, depths[i] - depths[i - 1]);
  return least;
}

/// Throws Error (input) for frames beside the stack, and warns of uneven ones.
void checkOffsets(const std::string& source, const std::vector<Place>& places,
                  const DicomAxes& axes, const std::vector<double>& pixelSpacing, const Vec3& step,
                  Stack& stack) {
  const Vec3 origin = lpsToRas * stack.grid.indexToWorld.translation();
  double maxOffset = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (stack.slicesOf(i).empty())
      continue;
    const auto slice = static_cast<double>(stack.slicesOf(i).front());
    const Vec3 offset = places[i].position - origin - slice * step;
    if (std::abs(offset.dot(axes.row)) > 0.5 * pixelSpacing[1] ||
        std::abs(offset.dot(axes.column)) > 0.5 * pixelSpacing[0])
      throw fieldError(source, "ImagePositionPatient",
                       "differs along the slices, so the frames do not form a volume; export the "
                       "segmentation as a volume");
    maxOffset = std::max(maxOffset, offset.norm());
  }
  if (maxOffset > 0.02 * step.norm())
    stack.warnings.push_back(makeMessage(ErrorCode::assumedGeometry, source, "frames are up to ",
                                         toString(maxOffset, 4), " mm off even spacing; ",
                                         toString(step.norm(), 4), " mm steps are used"));
}

Stack makeStack(const std::string& source, const DicomSegmentation& object, const Grid* reference) {
  checkFrames(source, object);
  const DicomFrame& first = object.frames.front();
  const DicomAxes axes = parseAxes(first.orientation, source);
  const Vec3 normal = axes.normal();
  std::vector<Place> places;
  for (const DicomFrame& frame : object.frames) {
    const Vec3 position(frame.position[0], frame.position[1], frame.position[2]);
    places.push_back({position, position.dot(normal)});
  }
  Stack stack;
  const double referenceStep = findReferenceStep(reference, lpsToRas * normal);
  const double stated = toLength(first.spacingBetweenSlices);
  const double finest = std::min(first.pixelSpacing[0], first.pixelSpacing[1]);
  const std::vector<double> depths =
      findPlanes(places, sameDepth * (stated > 0.0 ? stated : finest), stack.planeOfFrame);
  double length = chooseStep(first, depths, referenceStep);
  if (length == 0.0) {
    length = finest;
    stack.warnings.push_back(makeMessage(ErrorCode::assumedGeometry, source,
                                         "has one slice and states no SliceThickness; ",
                                         toString(length, 4), " mm is assumed"));
  }
  const std::int64_t slices = assignSlices(source, depths, length, stack.slicesOfPlane);
  const auto findPlace = [&](std::size_t plane) {
    const auto found = std::ranges::find(stack.planeOfFrame, plane);
    return places[static_cast<std::size_t>(found - stack.planeOfFrame.begin())].position;
  };
  const Vec3 origin = findPlace(0);
  const Vec3 step =
      slices == 1 ? Vec3(length * normal)
                  : Vec3((findPlace(depths.size() - 1) - origin) / static_cast<double>(slices - 1));
  const Mat3 steps(axes.row * first.pixelSpacing[1], axes.column * first.pixelSpacing[0], step);
  stack.grid = {Size3(object.columns, object.rows, slices),
                Affine(lpsToRas * steps, lpsToRas * origin)};
  checkOffsets(source, places, axes, first.pixelSpacing, step, stack);
  return stack;
}

// ---- labels

void checkPixels(const Path& path, const DicomSegmentation& object) {
  if (object.rows < 1 || object.columns < 1 || object.rows > 65535 || object.columns > 65535)
    throw fieldError(path, "Rows or Columns", "is missing; ", exportAgain);
  const bool isBinary = object.type == "BINARY", isLabelMap = object.type == "LABELMAP";
  if (!isBinary && !isLabelMap && object.type != "FRACTIONAL")
    throw fieldError(path, "SegmentationType", "\"", sanitize(object.type),
                     "\" is not supported; export a binary segmentation");
  const auto bits = static_cast<std::uint64_t>(object.rows) *
                    static_cast<std::uint64_t>(object.columns) *
                    static_cast<std::uint64_t>(object.bits);
  const bool isSupported =
      object.bits == 8 || (isLabelMap ? object.bits == 16 : isBinary && object.bits == 1);
  if (!isSupported)
    throw fieldError(path, "BitsAllocated", "is ", object.bits, ", which is not supported for ",
                     object.type, "; ", exportAgain);
  const std::uint64_t maxBits = 8 * countPixelBytes(path, object.isCompressed);
  if (bits > maxBits / std::max<std::uint64_t>(1, object.frames.size()))
    throw inputError(ErrorCode::damagedFile, concat(path, ": PixelData"),
                     "is shorter than Rows, Columns and frames say; ", exportAgain);
}

/// Stored values of frames.
class FrameSource {
public:
  FrameSource(const FrameReader& readFrames, const DicomSegmentation& object)
      : m_readFrames(readFrames), m_object(object) {}

  std::uint64_t pixels() const {
    return static_cast<std::uint64_t>(m_object.rows) * static_cast<std::uint64_t>(m_object.columns);
  }

  /// Calls use(frame, value) for each of some frames; value(pixel) is the stored value. Frames that
  /// follow each other in the file are read together.
  template <typename Use>
  void forEach(const std::vector<std::size_t>& frames, const Use& use) {
    const auto bits = static_cast<std::uint64_t>(m_object.bits);
    constexpr std::uint64_t maxBits = std::uint64_t{1} << 27;
    const std::uint64_t maxFrames = std::max<std::uint64_t>(1, maxBits / (bits * pixels()));
    for (std::size_t begin = 0, end = 0; begin < frames.size(); begin = end) {
      for (end = begin + 1;
           end < frames.size() && end - begin < maxFrames && frames[end] == frames[end - 1] + 1;)
        ++end;
      const std::string bytes = m_readFrames(frames[begin], end - begin);
      const std::uint64_t offset = frames[begin] * pixels() * bits % 8;
      for (std::size_t i = begin; i < end; ++i)
        use(frames[i], [&, start = (i - begin) * pixels()](std::uint64_t pixel) {
          return getValue(bytes, offset, start + pixel);
        });
    }
  }

private:
  std::int32_t getValue(const std::string& bytes, std::uint64_t offset, std::uint64_t at) const {
    const auto byte = [&](std::uint64_t i) { return static_cast<unsigned char>(bytes[i]); };
    if (m_object.bits == 1)
      return byte((offset + at) / 8) >> ((offset + at) % 8) & 1;
    return m_object.bits == 8 ? byte(at) : byte(2 * at) | byte(2 * at + 1) << 8;
  }

  const FrameReader& m_readFrames;
  const DicomSegmentation& m_object;
};

/// Least stored value that is inside a segment.
std::int32_t findThreshold(const Path& path, const DicomSegmentation& object) {
  if (object.type == "BINARY")
    return 1;
  if (!(object.maximum >= 1.0))
    throw fieldError(path, "MaximumFractionalValue", "is missing; ", exportAgain);
  return static_cast<std::int32_t>(std::ceil(0.5 * object.maximum));
}

/// Frames of each segment number, in the file's order.
std::map<std::int32_t, std::vector<std::size_t>> groupFrames(const Path& path,
                                                             const DicomSegmentation& object) {
  std::map<std::int32_t, std::vector<std::size_t>> groups;
  for (const DicomSegment& segment : object.segments)
    groups[segment.number] = {};
  for (std::size_t i = 0; i < object.frames.size(); ++i) {
    const auto group = groups.find(object.frames[i].segment);
    if (group == groups.end())
      throw fieldError(path, "ReferencedSegmentNumber", "is ", object.frames[i].segment,
                       ", but there is no such segment; ", exportAgain);
    group->second.push_back(i);
  }
  return groups;
}

/// Appends the runs of one frame's pixels of at least `threshold`.
template <typename Value>
void appendRuns(const Value& value, std::int32_t threshold, const Size3& size, std::int64_t slice,
                std::vector<VoxelRun>& runs) {
  for (std::int64_t y = 0; y < size.y(); ++y) {
    const auto row = static_cast<std::uint64_t>(y * size.x());
    const auto isInside = [&](std::int64_t x) {
      return value(row + static_cast<std::uint64_t>(x)) >= threshold;
    };
    for (std::int64_t x = 0; x < size.x(); ++x) {
      const std::int64_t first = x;
      while (x < size.x() && isInside(x))
        ++x;
      if (x > first)
        runs.push_back({y, slice, first, x});
    }
  }
}

/// Labels of a label map, whose pixels are segment numbers.
template <typename Label>
Labels readLabelMap(FrameSource& source, const DicomSegmentation& object, const Stack& stack) {
  LargeArray<Label> labels(static_cast<std::size_t>(stack.grid.voxelCount()));
  std::vector<std::size_t> frames(object.frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i)
    frames[i] = i;
  source.forEach(frames, [&](std::size_t frame, const auto& value) {
    for (const std::int64_t slice : stack.slicesOf(frame)) {
      Label* const to = labels.data() + static_cast<std::uint64_t>(slice) * source.pixels();
      for (std::uint64_t pixel = 0; pixel < source.pixels(); ++pixel)
        to[pixel] = static_cast<Label>(value(pixel));
    }
  });
  return labels;
}

/// Labels of a binary or fractional segmentation; sets the segments' layers.
LabelLayers readLayers(FrameSource& source, const Path& path, const DicomSegmentation& object,
                       const Stack& stack, std::int64_t maxLabels,
                       std::vector<SegmentInfo>& segments) {
  const std::int32_t threshold = findThreshold(path, object);
  auto framesOfNumber = groupFrames(path, object);
  LabelLayers layers(stack.grid.size, path.string(), maxLabels);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    std::vector<VoxelRun> runs;
    source.forEach(framesOfNumber[object.segments[i].number],
                   [&](std::size_t frame, const auto& value) {
                     for (const std::int64_t slice : stack.slicesOf(frame))
                       appendRuns(value, threshold, stack.grid.size, slice, runs);
                   });
    segments[i].layer = layers.add(runs, static_cast<LabelLayers::Label>(segments[i].labelValue));
  }
  return layers;
}

/// Most labels of all layers. Slices between planes are not in the file, so that they are limited
/// by its size and its pixels: a damaged file must not take memory that it can hardly describe.
std::int64_t countMaxLabels(const Path& path, const DicomSegmentation& object) {
  constexpr std::uint64_t labelsOfByte = 1 << 14, labelsOfPixel = 16;
  const std::uint64_t pixels = std::uint64_t{1} * static_cast<std::uint64_t>(object.rows) *
                               static_cast<std::uint64_t>(object.columns) * object.frames.size();
  const std::uint64_t most = std::max(labelsOfByte * std::filesystem::file_size(path),
                                      labelsOfPixel * pixels); // checkPixels: no overflow
  return static_cast<std::int64_t>(std::min(most, std::uint64_t{1} << 31));
}

void checkSize(const Path& path, const Grid& grid, std::int64_t maxLabels) {
  if (grid.voxelCount() > maxLabels)
    throw inputError(ErrorCode::limitExceeded, path, "has ", grid.voxelCount(),
                     " voxels, more than ", maxLabels, " for its size; crop the segmentation");
}

} // namespace

Segmentation makeFrameLabels(const FrameReader& readFrames, const Path& path,
                             const DicomSegmentation& object, std::vector<SegmentInfo> segments,
                             const Grid* reference) {
  checkPixels(path, object);
  const Stack stack = makeStack(path.string(), object, reference);
  const std::int64_t maxLabels = countMaxLabels(path, object);
  checkSize(path, stack.grid, maxLabels);
  FrameSource source(readFrames, object);
  std::size_t layerCount = 1;
  Labels labels;
  if (object.type != "LABELMAP") {
    LabelLayers layers = readLayers(source, path, object, stack, maxLabels, segments);
    layerCount = layers.count();
    labels = layers.takeInterleaved();
  } else if (object.bits == 8) {
    labels = readLabelMap<std::uint8_t>(source, object, stack);
  } else {
    labels = readLabelMap<std::int32_t>(source, object, stack);
  }
  Segmentation segmentation(path.string(), stack.grid, layerCount, std::move(labels),
                            std::move(segments));
  segmentation.addWarnings(stack.warnings);
  return segmentation;
}

} // namespace fenestra::core
