// Divides the slices of a series into volumes, and these into frames over time.
//
// Left out, with a warning that counts them: localizers; slices that cannot be placed, or whose
// size, orientation or spacing is not that of most slices; copies of another slice (equal instance
// uid and position, or equal position and voxels; where an acquisition continues another, a slice
// at the same position). What remains is one volume unless several slices share a position. Then
// the series is divided by the echo time, b-value, image type and convolution kernel, as far as
// each divides it into nearly complete volumes; and each volume into frames by the temporal
// position, cardiac phase, trigger time, acquisition or its time, else in the order of the instance
// numbers if all positions have equally many slices. Temporal positions and acquisitions are frames
// also if their positions interleave (DicomPhases.h).

#include "base/Distribution.h"
#include "base/Error.h"
#include "files/medical/DicomPhases.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace fenestra::core {
namespace {

using Groups = std::vector<DicomSlices>;

constexpr double samePosition = 1e-3; ///< mm

/// Greatest distance along the normal of slices at one position, mm: phases of a scan may differ by
/// a small part of the slice thickness.
double findTolerance(const DicomHeader& h) {
  constexpr double fraction = 0.02;
  return h.sliceThickness.size() == 1 ? std::max(samePosition, fraction * h.sliceThickness[0])
                                      : samePosition;
}

/// True if the slice has what a volume needs. `isComplete` is checked when it is read.
bool canBePlaced(const DicomSlice& slice) {
  const DicomHeader& h = slice.header;
  return h.samples == 1 && h.photometric.starts_with("MONOCHROME") && h.rows > 0 && h.columns > 0 &&
         h.position.size() == 3 && findAxes(h.orientation) && h.pixelSpacing.size() == 2 &&
         h.pixelSpacing[0] > 0.0 && h.pixelSpacing[1] > 0.0;
}

bool isLocalizer(const DicomSlice& slice) {
  return slice.header.imageType.find("LOCALIZER") != std::string::npos;
}

bool hasSameGeometry(const DicomHeader& a, const DicomHeader& b) {
  const auto isNear = [](const std::vector<double>& x, const std::vector<double>& y, double error) {
    return std::ranges::equal(x, y, [=](double p, double q) { return std::abs(p - q) <= error; });
  };
  return a.rows == b.rows && a.columns == b.columns && isNear(a.orientation, b.orientation, 1e-3) &&
         isNear(a.pixelSpacing, b.pixelSpacing, 1e-3 * b.pixelSpacing[0]);
}

/// Removes the slices for which `isOut` is true; returns their number.
template <typename Predicate>
std::size_t leaveOut(DicomSlices& slices, Predicate&& isOut) {
  return std::erase_if(slices, isOut);
}

/// Keeps the largest group of slices with equal geometry; returns the number of the others.
std::size_t keepLargestGeometry(DicomSlices& slices) {
  std::vector<std::pair<DicomHeader, std::size_t>> kinds;
  for (const DicomSlice& slice : slices) {
    const auto known = std::ranges::find_if(
        kinds, [&](const auto& kind) { return hasSameGeometry(slice.header, kind.first); });
    if (known == kinds.end())
      kinds.emplace_back(slice.header, 1);
    else
      ++known->second;
  }
  const auto most =
      std::ranges::max_element(kinds, {}, [](const auto& kind) { return kind.second; });
  const DicomHeader kept = most->first;
  return leaveOut(slices, [&](const DicomSlice& s) { return !hasSameGeometry(s.header, kept); });
}

/// Removes further copies of an instance.
std::size_t removeCopies(DicomSlices& slices) {
  std::set<std::tuple<std::string, unsigned, long, long, long>> known;
  return leaveOut(slices, [&](const DicomSlice& slice) {
    const DicomHeader& h = slice.header;
    const auto round = [&](std::size_t i) {
      return std::lround(std::clamp(h.position[i], -1e12, 1e12) / samePosition);
    };
    return !h.sopUid.empty() &&
           !known.emplace(h.sopUid, h.frame, round(0), round(1), round(2)).second;
  });
}

// ---- positions

/// Slices by their position along the normal.
class Stations {
public:
  explicit Stations(const DicomSlices& slices) {
    const Vec3 normal = findAxes(slices.front().header.orientation)->normal();
    std::vector<std::pair<double, std::size_t>> depths;
    for (std::size_t i = 0; i < slices.size(); ++i)
      depths.emplace_back(getPosition(slices[i]).dot(normal), i);
    std::ranges::sort(depths);
    const double tolerance = findTolerance(slices.front().header);
    for (std::size_t i = 0; i < depths.size(); ++i) {
      if (i == 0 || depths[i].first - depths[i - 1].first > tolerance)
        m_indices.emplace_back();
      m_indices.back().push_back(depths[i].second);
    }
  }

  /// Indices of the slices at each position.
  const std::vector<std::vector<std::size_t>>& indices() const { return m_indices; }
  std::size_t count() const { return m_indices.size(); }
  /// Greatest number of slices at one position.
  std::size_t multiplicity() const {
    std::size_t most = 0;
    for (const auto& station : m_indices)
      most = std::max(most, station.size());
    return most;
  }

private:
  std::vector<std::vector<std::size_t>> m_indices;
};

// ---- keys

/// What a slice states about one key, as a number to sort by and as text.
struct KeyValue {
  double number = 0.0;
  std::string text = {};
  bool operator==(const KeyValue&) const = default;
  bool operator<(const KeyValue& other) const {
    return std::tie(number, text) < std::tie(other.number, other.text);
  }
};
using GetKey = KeyValue (*)(const DicomHeader&);

template <std::optional<double> DicomHeader::*member>
KeyValue getNumber(const DicomHeader& h) {
  return {(h.*member).value_or(0.0)};
}

KeyValue getEcho(const DicomHeader& h) {
  return {h.echoTime.value_or(0.0), concat("echo ", toString(h.echoTime.value_or(0.0)), " ms")};
}
KeyValue getDiffusion(const DicomHeader& h) {
  constexpr double geOffset = 1e5; // GE adds multiples of it, 1e9 for instance
  const double b = std::fmod(h.bValue.value_or(0.0), geOffset);
  return {b, concat("b ", toString(b))};
}
KeyValue getType(const DicomHeader& h) {
  const std::vector<std::string> words = split(h.imageType, '\\');
  std::vector<std::string> kind(words.begin() + std::min<std::ptrdiff_t>(2, std::ssize(words)),
                                words.end());
  return {0.0, concat("type ", join(kind, "/"))};
}
KeyValue getKernel(const DicomHeader& h) {
  return {0.0, concat("kernel ", replaceAll(h.convolutionKernel, "\\", "/"))};
}

constexpr GetKey partKeys[] = {getEcho, getDiffusion, getType, getKernel};

/// Whether groups with different values can be phases whose positions interleave.
enum class Interleaving { never, possible, certain };
struct TimeKey {
  GetKey get;
  Interleaving interleaving = Interleaving::never;
};
constexpr TimeKey timeKeys[] = {{getNumber<&DicomHeader::temporalPosition>, Interleaving::certain},
                                {getNumber<&DicomHeader::cardiacPhase>},
                                {getNumber<&DicomHeader::triggerTime>},
                                {getNumber<&DicomHeader::acquisition>, Interleaving::possible},
                                {getNumber<&DicomHeader::acquisitionTime>, Interleaving::possible}};

/// Divides slices of which several share a position, by the values of a key, if these are nearly
/// complete volumes; incomplete ones are left out and counted. Else returns all together.
std::vector<std::pair<std::string, DicomSlices>> divide(DicomSlices slices, GetKey getKey,
                                                        std::size_t& leftOut) {
  std::vector<std::pair<std::string, DicomSlices>> parts;
  const Stations stations(slices);
  std::map<KeyValue, DicomSlices> byValue;
  if (stations.multiplicity() > 1)
    for (const DicomSlice& slice : slices)
      byValue[getKey(slice.header)].push_back(slice);
  std::size_t kept = 0;
  if (byValue.size() > 1)
    for (auto& [value, group] : byValue) {
      const Stations own(group);
      if (2 * own.count() < stations.count() || own.multiplicity() >= stations.multiplicity())
        continue;
      kept += group.size();
      parts.emplace_back(value.text, std::move(group));
    }
  if (4 * kept < 3 * slices.size()) {
    parts.clear();
    parts.emplace_back("", std::move(slices));
    return parts;
  }
  leftOut += slices.size() - kept;
  return parts;
}

/// Divides by a time if several slices share a position, or if phases interleave; those of less
/// than half of the largest are left out and counted. Else returns all together, as acquisitions
/// that continue each other.
Groups divideByKey(DicomSlices slices, const TimeKey& key, std::size_t& leftOut) {
  std::map<KeyValue, DicomSlices> byValue;
  if (key.interleaving != Interleaving::never)
    for (const DicomSlice& slice : slices)
      byValue[key.get(slice.header)].push_back(slice);
  Groups groups;
  for (auto& [value, group] : byValue)
    groups.push_back(std::move(group));
  const auto findMost = [](const Groups& all) {
    return std::ranges::max_element(all, {}, &DicomSlices::size)->size();
  };
  Groups phases = joinPhases(groups);
  constexpr std::size_t fewest = 3; // slices; single ones do not show what they continue
  if (phases.size() == 1 && findMost(groups) >= fewest)
    return {std::move(slices)};
  auto parts = divide(std::move(slices), key.get, leftOut);
  const bool interleaves =
      phases.size() > 1 && (key.interleaving == Interleaving::certain || !canBeOneVolume(phases));
  if (parts.size() > 1 || !interleaves) {
    phases.clear();
    for (auto& [text, part] : parts)
      phases.push_back(std::move(part));
    return phases;
  }
  const std::size_t most = findMost(phases);
  std::erase_if(phases, [&](const DicomSlices& phase) {
    const bool isSmall = 2 * phase.size() < most;
    leftOut += isSmall ? phase.size() : 0;
    return isSmall;
  });
  return phases;
}

/// Divides by the instance numbers if all positions have equally many slices; else returns all
/// together.
Groups divideByInstance(DicomSlices slices) {
  const Stations stations(slices);
  const std::size_t count = stations.multiplicity();
  if (count == 1 || stations.count() * count != slices.size())
    return {std::move(slices)};
  Groups groups(count);
  for (std::vector<std::size_t> station : stations.indices()) {
    std::ranges::stable_sort(station, {}, [&](std::size_t i) {
      return std::tuple(slices[i].header.instance.value_or(0.0), slices[i].header.frame);
    });
    for (std::size_t k = 0; k < count; ++k)
      groups[k].push_back(slices[station[k]]);
  }
  return groups;
}

/// Removes slices with the position and the voxels of another.
std::size_t removeEqualVoxels(DicomSlices& slices) {
  const Stations stations(slices);
  if (stations.multiplicity() == 1)
    return 0;
  DicomReader files;
  std::set<std::size_t> copies;
  for (const std::vector<std::size_t>& station : stations.indices()) {
    std::map<std::string, std::size_t> known;
    for (const std::size_t i : station)
      if (const DicomSlice& s = slices[i]; station.size() > 1 && s.header.isComplete) {
        checkDicomPixels(s.path, s.header);
        if (!known.emplace(files.readVoxels(s.path, s.header), i).second)
          copies.insert(i);
      }
  }
  std::size_t i = 0;
  return leaveOut(slices, [&](const DicomSlice&) { return copies.contains(i++); });
}

/// Where an acquisition begins at the last position of an earlier one, keeps the slice of the
/// earlier one. Returns the number of the others.
std::size_t removeSharedEnds(DicomSlices& slices) {
  const auto getAcquisition = [&](std::size_t i) { return slices[i].header.acquisition; };
  std::set<std::optional<double>> acquisitions;
  for (const DicomSlice& slice : slices)
    acquisitions.insert(slice.header.acquisition);
  const Stations stations(slices);
  std::set<std::size_t> later;
  for (std::vector<std::size_t> station : stations.indices()) {
    std::ranges::sort(station, {}, getAcquisition);
    if (std::ranges::adjacent_find(station, std::equal_to(), getAcquisition) != station.end())
      return 0;
    later.insert(station.begin() + 1, station.end());
  }
  if (later.size() >= acquisitions.size())
    return 0;
  std::size_t i = 0;
  return leaveOut(slices, [&](const DicomSlice&) { return later.contains(i++); });
}

struct LeftOut {
  std::size_t localizers = 0, unplaced = 0, geometry = 0, copies = 0, incomplete = 0,
              sharedEnds = 0;
};

/// Frames over time of one volume.
Groups divideByTime(DicomSlices slices, LeftOut& out) {
  Groups frames = {std::move(slices)};
  for (const TimeKey& key : timeKeys) {
    Groups divided;
    for (DicomSlices& frame : frames)
      std::ranges::move(divideByKey(std::move(frame), key, out.incomplete),
                        std::back_inserter(divided));
    frames = std::move(divided);
  }
  Groups all;
  for (DicomSlices& frame : frames) {
    out.copies += removeEqualVoxels(frame);
    out.sharedEnds += removeSharedEnds(frame);
    std::ranges::move(divideByInstance(std::move(frame)), std::back_inserter(all));
  }
  return all;
}

void addWarnings(const LeftOut& out, const std::string& name, std::size_t all,
                 std::vector<Message>& warnings) {
  const auto warn = [&](std::size_t count, const char* what) {
    if (count > 0)
      warnings.push_back(makeMessage(ErrorCode::omittedSlices, name, count, " of ", all,
                                     count == 1 ? " slices is" : " slices are",
                                     " left out: ", what));
  };
  warn(out.localizers, "localizers");
  warn(out.unplaced, "no gray images, or without a position");
  warn(out.geometry, "their size, spacing or orientation is not that of most slices");
  warn(out.copies, "copies of other slices");
  warn(out.sharedEnds, "at the position of a slice of an earlier acquisition");
  warn(out.incomplete, "they are less than half of a volume");
}

DicomSeries describe(const DicomSlice& slice) {
  const DicomHeader& h = slice.header;
  return {h.seriesUid, h.seriesNumber, h.seriesDescription, h.modality};
}

} // namespace

std::vector<DicomSeries> splitSeries(DicomSlices slices, const std::string& name) {
  DicomSeries series = describe(slices.front());
  const std::size_t all = slices.size();
  if (std::ranges::none_of(slices, canBePlaced)) {
    series.frames = {std::move(slices)};
    series.isVolume = false;
    return {series};
  }
  LeftOut out;
  out.unplaced =
      leaveOut(slices, [](const DicomSlice& s) { return s.header.isComplete && !canBePlaced(s); });
  if (!std::ranges::all_of(slices, canBePlaced)) { // a damaged one, which is reported when read
    series.frames = {std::move(slices)};
    return {series};
  }
  if (!std::ranges::all_of(slices, isLocalizer))
    out.localizers = leaveOut(slices, isLocalizer);
  out.geometry = keepLargestGeometry(slices);
  out.copies = removeCopies(slices);
  std::vector<std::pair<std::string, DicomSlices>> parts = {{"", std::move(slices)}};
  for (const GetKey key : partKeys) {
    std::vector<std::pair<std::string, DicomSlices>> divided;
    for (auto& [outer, part] : parts)
      for (auto& [inner, group] : divide(std::move(part), key, out.incomplete))
        divided.emplace_back(concat(outer, outer.empty() || inner.empty() ? "" : ", ", inner),
                             std::move(group));
    parts = std::move(divided);
  }
  std::vector<DicomSeries> volumes;
  for (auto& [text, part] : parts) {
    DicomSeries& volume = volumes.emplace_back(series);
    volume.part = text;
    volume.frames = divideByTime(std::move(part), out);
  }
  for (DicomSeries& volume : volumes)
    addWarnings(out, name, all, volume.warnings);
  return volumes;
}

} // namespace fenestra::core
