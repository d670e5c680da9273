#include "scene/VolumeSmoothing.h"

#include "base/PhysicalMemory.h"
#include "base/TextStream.h"
#include "model/filtering/Islands.h"
#include "model/filtering/NoiseEstimate.h"
#include "model/filtering/NonLocalMeans.h"
#include "scene/Defaults.h"

#include <algorithm>

namespace fenestra {
namespace {

/// Compares with physical memory, since Linux grants more and kills the process when it is used.
void checkMemory(const Volume& volume) {
  constexpr double gigabyte = 1e9;
  const double needed = std::visit(
      [](const auto& voxels) {
        return 2.0 * static_cast<double>(voxels.size() * sizeof(voxels[0]));
      },
      volume.voxels);
  const double available = physicalMemory();
  if (needed > available)
    throw outputError(ErrorCode::outOfMemory, "--volume-smoothing",
                      "the volume and its smoothed copy need ", toString(needed / gigabyte, 3),
                      " GB of memory, but this machine has ", toString(available / gigabyte, 3),
                      "; use --volume-smoothing off");
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

} // namespace

Modality findModality(const Volume& volume, const std::optional<Modality>& transferModality,
                      const std::string& transferName) {
  if (isPlausibleModality(Modality::ct, volume))
    return Modality::ct;
  return transferModality == Modality::us || transferName.starts_with("us-") ? Modality::us
                                                                             : Modality::mr;
}

SmoothedVolume smoothVolume(const VolumeHandle& read, const SmoothingRequest& request,
                            Modality modality) {
  const Volume& volume = read->volume;
  checkMemory(volume);
  const bool isGiven = request.kind == SmoothingRequest::Kind::given;
  SmoothedVolume result{{}, {.isLogarithmic = modality == Modality::us}};
  SmoothingReport& report = result.report;
  report.noise = isGiven ? request.noise : estimateNoise(volume, modality);
  if (isGiven && report.isLogarithmic) // derivative of the logarithm at the mean
    report.noise /= 1.0 + mean(volume) - volume.minimum;
  if (!isGiven && report.noise < findLeastNoise(volume, modality))
    return result;
  report.strength = chooseStrength(modality) * report.noise;
  result.input = {
      applyNonLocalMeans(volume, {report.noise, report.strength, report.isLogarithmic})};
  return result;
}

SmoothedVolume dropIslands(const VolumeHandle& smoothed, const Handle<TransferChoice>& transfer) {
  const std::optional<double> onset = findOnset(transfer->function);
  if (!onset)
    return {};
  const Islands islands = findIslands(smoothed->volume, *onset, *transfer->islands);
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
  TextWriter line;
  line << "smoothed by non-local means" << (report.isLogarithmic ? " of logarithms" : "")
       << ": noise " << toString(report.noise, 3) << ", strength " << toString(report.strength, 3);
  if (report.islands > 0)
    line << ", " << report.islands << " islands of opacity removed ("
         << toString(report.islandVolume, 3) << " mm^3)";
  line << "; lesions";
  for (const LesionContrast& lesion : lesionContrasts)
    line << (&lesion == lesionContrasts ? " of " : ", ") << lesion.diameter << " mm keep "
         << lesion.percent << " %";
  line << " of their contrast (measured on one CT); --volume-smoothing off leaves the volume raw";
  return line.str();
}

} // namespace fenestra
