#include "scene/VolumeSmoothing.h"

#include "base/PhysicalMemory.h"
#include "base/TextStream.h"
#include "io/Digest.h"
#include "io/platform/SharedSlot.h"
#include "model/filtering/Islands.h"
#include "model/filtering/NoiseEstimate.h"
#include "model/filtering/NonLocalMeans.h"
#include "scene/Defaults.h"

#include <algorithm>

namespace fenestra::core {
namespace {

/// Compares with physical memory, since Linux grants more and kills the process when it is used.
std::optional<Message> findMemoryProblem(const Volume& volume) {
  constexpr double gigabyte = 1e9;
  const double needed = std::visit(
      [](const auto& voxels) {
        return 3.0 * static_cast<double>(voxels.size() * sizeof(voxels[0]));
      },
      volume.voxels);
  const double available = physicalMemory();
  if (needed <= available)
    return std::nullopt;
  return makeMessage(ErrorCode::outOfMemory, volume.name, "smoothing needs ",
                     toString(needed / gigabyte, 3), " GB of memory, but this machine has ",
                     toString(available / gigabyte, 3), ", so the volume is not smoothed");
}

double mean(const Volume& volume) {
  const auto compute = [](const auto& voxels) {
    double sum = 0.0;
    for (const auto voxel : voxels)
      sum += static_cast<double>(voxel);
    return sum / static_cast<double>(voxels.size());
  };
  return std::visit(compute, volume.voxels);
}

/// Least noise that is worth smoothing.
double findLeastNoise(const Volume& volume, Modality modality) {
  constexpr double hounsfield = 3.0, fraction = 0.003;
  const double range = volume.maximum - volume.minimum;
  return modality == Modality::ct
             ? hounsfield
             : fraction * (modality == Modality::us ? std::log1p(range) : range);
}

/// Strength of the filter, as a factor on the noise. CT: SmoothingBenchmark shows what is left.
double chooseStrength(Modality modality) {
  return modality == Modality::ct ? 1.1 : 1.0;
}

/// Estimates the noise unless it is given, and filters. Throws as requireRunning.
SmoothedVolume filterVolume(const Volume& volume, const SmoothingRequest& request,
                            Modality modality, const StopFlag& stop) {
  const bool isGiven = request.kind == SmoothingRequest::Kind::given;
  SmoothedVolume result{.report = {.isLogarithmic = modality == Modality::us,
                                   .isHounsfield = modality == Modality::ct}};
  SmoothingReport& report = result.report;
  report.noise = isGiven ? request.noise : estimateNoise(volume, modality);
  if (isGiven && report.isLogarithmic) // derivative of the logarithm at the mean
    report.noise /= 1.0 + mean(volume) - volume.minimum;
  if ((!isGiven && report.noise < findLeastNoise(volume, modality)) ||
      volume.minimum == volume.maximum)
    return result;
  report.strength = chooseStrength(modality) * report.noise;
  requireRunning(stop);
  result.input = {
      applyNonLocalMeans(volume, {report.noise, report.strength, report.isLogarithmic}, stop)};
  requireRunning(stop);
  return result;
}

template <typename Array>
auto bytesOf(Array& voxels) {
  using Byte = std::conditional_t<std::is_const_v<Array>, const char, char>;
  return std::span(reinterpret_cast<Byte*>(voxels.data()), voxels.size() * sizeof(voxels[0]));
}

/// Digest of all that the result of filterVolume() depends on.
std::uint64_t computeKey(const Volume& volume, const SmoothingRequest& request, Modality modality) {
  constexpr int exact = 17; // significant digits
  const Grid& grid = volume.grid;
  Digest digest;
  digest.add(concat(joinNumbers(grid.size.cast<double>(), ",", exact), ' ',
                    joinNumbers(grid.spacing(), ",", exact), ' ', volume.voxels.index(), ' ',
                    static_cast<int>(modality), ' ', static_cast<int>(request.kind), ' ',
                    toString(request.noise, exact)));
  std::visit(
      [&](const auto& voxels) {
        const auto bytes = bytesOf(voxels);
        digest.add({bytes.data(), bytes.size()});
      },
      volume.voxels);
  return digest.value();
}

/// Result that another row of the batch has stored; nullopt: none.
std::optional<SmoothedVolume> readResult(const SharedSlot& slot, std::uint64_t key,
                                         const Volume& volume, Modality modality) {
  Volume smoothed = copyWithoutVoxels(volume);
  const auto numbers = std::visit(
      [&]<typename Array>(const Array& voxels) {
        return slot.read(key, bytesOf(smoothed.voxels.emplace<Array>(voxels.size())));
      },
      volume.voxels);
  if (!numbers)
    return std::nullopt;
  computeRange(smoothed);
  return SmoothedVolume{{{std::move(smoothed)}},
                        {.noise = numbers->at(0),
                         .strength = numbers->at(1),
                         .isReused = true,
                         .isLogarithmic = modality == Modality::us,
                         .isHounsfield = modality == Modality::ct}};
}

/// True for runs with a voxel in the focus, which must not vanish.
class FocusOverlap {
public:
  FocusOverlap(const Mask& focus, const Grid& volume)
      : m_focus(focus),
        m_size(volume.size),
        m_toFocus(focus.grid.worldToIndex * volume.indexToWorld) {}

  bool operator()(const RunOfIsland& run) const {
    const Vec3 last = (m_focus.grid.size.array() - 1).cast<double>();
    for (std::int64_t i = run.begin; i < run.end; ++i) {
      const Size3 voxel(i % m_size.x(), i / m_size.x() % m_size.y(), i / m_size.x() / m_size.y());
      const Vec3 at = (m_toFocus * Vec3(voxel.cast<double>())).array().round();
      if ((at.array() >= 0.0).all() && (at.array() <= last.array()).all() &&
          m_focus.voxels[linearIndex(at.cast<std::int64_t>(), m_focus.grid.size)] >=
              m_focus.threshold())
        return true;
    }
    return false;
  }

private:
  const Mask& m_focus;
  Size3 m_size;
  Affine m_toFocus;
};

} // namespace

Modality findModality(const Volume& volume, const std::optional<Modality>& transferModality,
                      const std::string& transferName) {
  if (volume.modality)
    return *volume.modality;
  if (isPlausibleModality(Modality::ct, volume))
    return Modality::ct;
  return transferModality == Modality::us || transferName.starts_with("us-") ? Modality::us
                                                                             : Modality::mr;
}

SmoothedVolume smoothVolume(const VolumeHandle& read, const SmoothingRequest& request,
                            Modality modality, const StageStop& stop) {
  const Volume& volume = read->volume;
  if (const auto problem = findMemoryProblem(volume))
    return {.warnings = {*problem}};
  const auto slot = SharedSlot::findInherited();
  if (!slot)
    return filterVolume(volume, request, modality, *stop.flag);
  const std::uint64_t key = computeKey(volume, request, modality);
  if (auto reused = readResult(*slot, key, volume, modality))
    return std::move(*reused);
  SmoothedVolume result = filterVolume(volume, request, modality, *stop.flag);
  if (result.input)
    std::visit(
        [&](const auto& voxels) {
          slot->write(key, {result.report.noise, result.report.strength}, bytesOf(voxels));
        },
        result.input->volume.voxels);
  return result;
}

SmoothedVolume dropIslands(const VolumeHandle& smoothed, const Handle<TransferChoice>& transfer,
                           const FocusHandle& focus) {
  const std::optional<double> onset = findOnset(transfer->function);
  if (!onset)
    return {};
  RunPredicate isPreserved;
  if (focus->mask)
    isPreserved = FocusOverlap(*focus->mask, smoothed->volume.grid);
  const Islands islands = findIslands(smoothed->volume, *onset, *transfer->islands, isPreserved);
  if (islands.runs.empty())
    return {};
  SmoothedVolume result{*smoothed, {.islands = islands.count, .islandVolume = islands.volume}};
  removeIslands(result.input->volume, islands, *onset);
  return result;
}

std::optional<double> findOnset(const TransferFunction& transfer) {
  const auto& knots = transfer.extinction.knots();
  const auto opaque =
      std::ranges::find_if(knots, [](const auto& knot) { return knot.value[0] > 0.0; });
  if (opaque == knots.begin() || opaque == knots.end())
    return std::nullopt;
  return std::prev(opaque)->position;
}

std::string describe(const SmoothingReport& report) {
  const char* const unit = report.isHounsfield ? " HU" : "";
  if (!report.isApplied())
    return report.noise > 0.0
               ? concat("not smoothed, since its noise is only ", toString(report.noise, 2), unit)
               : "not smoothed";
  TextWriter line;
  line << "smoothed by non-local means" << (report.isLogarithmic ? " of logarithms" : "")
       << ": noise " << toString(report.noise, 3) << unit << ", strength "
       << toString(report.strength, 3) << unit;
  if (report.islands > 0)
    line << ", " << report.islands << " islands of opacity removed ("
         << toString(report.islandVolume, 3) << " mm^3)";
  if (report.isHounsfield) {
    line << "; lesions";
    for (const LesionContrast& lesion : lesionContrasts)
      line << (&lesion == lesionContrasts ? " of " : ", ") << lesion.diameter << " mm keep "
           << lesion.percent << " %";
    line << " of their contrast (measured on one CT)";
  }
  return line.str();
}

} // namespace fenestra::core
