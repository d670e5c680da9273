// What non-local means removes from a CT, and what it leaves: noise in the liver, contrast of the
// lungs' vessels, bone, and spheres of 4 to 20 mm that are added to the liver as lesions. For each
// strength h, relative to the estimated noise, prints CSV. Values are percentages of the raw
// volume's.
//
//     SmoothingBenchmark [STRENGTH...]     (default: 0.8 0.9 1 1.1)

#include "base/InstructionSets.h"
#include "files/medical/VolumeReader.h"
#include "model/filtering/NoiseEstimate.h"
#include "model/filtering/NonLocalMeans.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <ctime>
#include <filesystem>
#include <functional>
#include <iostream>
#include <random>

namespace fenestra::core {
namespace {

using Values = std::vector<float>;

/// A number per voxel of a grid, with filters along the axes.
struct Field3 {
  Size3 size;
  Values values;

  /// Each voxel from the 2 radius + 1 voxels along an axis; the border repeats.
  template <typename Combine>
  Field3 filter(int axis, std::int64_t radius, Combine&& combine) const {
    Field3 result{size, Values(values.size())};
    tbb::parallel_for(std::int64_t{0}, size.z(), [&](std::int64_t z) {
      Values line(static_cast<std::size_t>(2 * radius + 1));
      for (std::int64_t y = 0; y < size.y(); ++y)
        for (std::int64_t x = 0; x < size.x(); ++x) {
          for (std::int64_t k = -radius; k <= radius; ++k) {
            Size3 at(x, y, z);
            at[axis] = std::clamp(at[axis] + k, std::int64_t{0}, size[axis] - 1);
            line[static_cast<std::size_t>(k + radius)] = values[linearIndex(at, size)];
          }
          result.values[linearIndex({x, y, z}, size)] = combine(line);
        }
    });
    return result;
  }

  /// `sigma`: voxels.
  Field3 blur(const Vec3& sigma) const {
    Field3 result = *this;
    for (int axis = 0; axis < 3; ++axis) {
      const auto radius = static_cast<std::int64_t>(std::lround(2.5 * sigma[axis]));
      Values weights;
      for (std::int64_t k = -radius; k <= radius; ++k)
        weights.push_back(
            static_cast<float>(std::exp(-0.5 * std::pow(static_cast<double>(k) / sigma[axis], 2))));
      result = result.filter(axis, radius, [&](const Values& line) {
        float sum = 0.0F, all = 0.0F;
        for (std::size_t i = 0; i < line.size(); ++i) {
          sum += weights[i] * line[i];
          all += weights[i];
        }
        return sum / all;
      });
    }
    return result;
  }

  /// Difference from the gray-scale opening by a box: what is narrower than the box.
  Field3 topHat(const Size3& radius) const {
    Field3 opened = *this;
    for (int axis = 0; axis < 3; ++axis)
      opened =
          opened.filter(axis, radius[axis], [](const Values& v) { return std::ranges::min(v); });
    for (int axis = 0; axis < 3; ++axis)
      opened =
          opened.filter(axis, radius[axis], [](const Values& v) { return std::ranges::max(v); });
    return minus(opened);
  }

  Field3 minus(const Field3& other) const {
    Field3 result = *this;
    for (std::size_t i = 0; i < values.size(); ++i)
      result.values[i] -= other.values[i];
    return result;
  }
};

Field3 toField(const Volume& volume) {
  Field3 field{volume.grid.size, {}};
  std::visit([&](const auto& v) { field.values.assign(v.begin(), v.end()); }, volume.voxels);
  return field;
}

using Selection = std::vector<std::size_t>; ///< voxels

Selection select(const Field3& field, const std::function<bool(float)>& isIncluded) {
  Selection selection;
  for (std::size_t i = 0; i < field.values.size(); ++i)
    if (isIncluded(field.values[i]))
      selection.push_back(i);
  return selection;
}

/// Voxels of the labels, without their outermost layers.
Selection selectInside(const Field3& labels, float first, float last, std::int64_t layers) {
  Field3 inside = labels;
  for (float& value : inside.values)
    value = value >= first && value <= last ? 1.0F : 0.0F;
  for (int axis = 0; axis < 3; ++axis)
    inside = inside.filter(axis, layers, [](const Values& v) { return std::ranges::min(v); });
  return select(inside, [](float value) { return value > 0.5F; });
}

double mean(const Field3& field, const Selection& selection) {
  double sum = 0.0;
  for (const std::size_t i : selection)
    sum += static_cast<double>(field.values[i]);
  return sum / static_cast<double>(selection.size());
}

double deviation(const Field3& field, const Selection& selection) {
  const double center = mean(field, selection);
  double squares = 0.0;
  for (const std::size_t i : selection)
    squares += std::pow(static_cast<double>(field.values[i]) - center, 2);
  return std::sqrt(squares / static_cast<double>(selection.size()));
}

struct Lesion {
  Vec3 center;     ///< mm from the first voxel
  double diameter; ///< mm
};

/// Spheres of different sizes and contrasts in the liver, at least 6 mm apart and inside.
class Lesions {
public:
  static constexpr std::array<double, 5> diameters = {4.0, 6.0, 8.0, 12.0, 20.0};

  Lesions(const Grid& grid, const Selection& liver) : m_size(grid.size), m_spacing(grid.spacing()) {
    std::mt19937 random(5);
    Selection places = liver;
    std::ranges::shuffle(places, random);
    for (const double diameter : diameters)
      for (const double contrast : {-20.0, -40.0, 60.0})
        for (int n = 0; n < 6; ++n)
          place(places, diameter, contrast);
  }

  /// Copy of the volume with the lesions.
  Volume addTo(const Volume& volume) const {
    Volume result = volume;
    const auto add = [&](auto& voxels) {
      using Voxel = typename std::remove_cvref_t<decltype(voxels)>::value_type;
      for (std::size_t n = 0; n < m_lesions.size(); ++n)
        visit(m_lesions[n], m_lesions[n].diameter / 2.0 + 4.0, [&](std::size_t i, double radius) {
          const double profile =
              m_contrasts[n] / (1.0 + std::exp((radius - m_lesions[n].diameter / 2.0) / 0.5));
          voxels[i] = static_cast<Voxel>(static_cast<double>(voxels[i]) + std::round(profile));
        });
    };
    std::visit(add, result.voxels);
    return result;
  }

  /// Contrast in the middle of the lesions of one size: mean of `after` over `before`.
  double contrast(double diameter, const Field3& before, const Field3& after) const {
    double sum = 0.0, count = 0.0;
    for (const Lesion& lesion : m_lesions) {
      if (lesion.diameter != diameter)
        continue;
      double left = 0.0, all = 0.0;
      visit(lesion, std::max(diameter / 4.0, 1.3), [&](std::size_t i, double) {
        left += static_cast<double>(after.values[i]);
        all += static_cast<double>(before.values[i]);
      });
      sum += left / all;
      count += 1.0;
    }
    return sum / count;
  }

private:
  void place(const Selection& places, double diameter, double contrast) {
    for (const std::size_t place : places) {
      const auto i = static_cast<std::int64_t>(place);
      const Size3 voxel(i % m_size.x(), i / m_size.x() % m_size.y(), i / m_size.x() / m_size.y());
      const Vec3 center = voxel.cast<double>().cwiseProduct(m_spacing);
      const bool isFree = std::ranges::all_of(m_lesions, [&](const Lesion& other) {
        return (center - other.center).norm() > (diameter + other.diameter) / 2.0 + 6.0;
      });
      if (!isFree)
        continue;
      m_lesions.push_back({center, diameter});
      m_contrasts.push_back(contrast);
      return;
    }
  }

  template <typename Visit>
  void visit(const Lesion& lesion, double radius, Visit&& visitVoxel) const {
    const Size3
        first = ((lesion.center.array() - radius) / m_spacing.array()).floor().cast<std::int64_t>(),
        last = ((lesion.center.array() + radius) / m_spacing.array()).ceil().cast<std::int64_t>();
    Size3 at;
    for (at.z() = first.z(); at.z() <= last.z(); ++at.z())
      for (at.y() = first.y(); at.y() <= last.y(); ++at.y())
        for (at.x() = first.x(); at.x() <= last.x(); ++at.x())
          if (const double r = (at.cast<double>().cwiseProduct(m_spacing) - lesion.center).norm();
              r < radius)
            visitVoxel(linearIndex(at, m_size), r);
  }

  Size3 m_size;
  Vec3 m_spacing;
  std::vector<Lesion> m_lesions;
  std::vector<double> m_contrasts;
};

double cpuSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void measure(const Volume& volume, const Field3& labels, const std::vector<double>& strengths) {
  const Field3 raw = toField(volume), fine = raw.blur({0.8, 0.8, 0.4});
  const Vec3 trend = 5.0 * volume.grid.spacing().cwiseInverse();
  const Selection liver = selectInside(labels, 1.0F, 1.0F, 4);
  const Field3 lungs = [&] {
    Field3 selected = fine.topHat({3, 3, 1});
    Selection inside = selectInside(labels, 2.0F, 6.0F, 3);
    Field3 result{selected.size, Values(selected.values.size(), 0.0F)};
    for (const std::size_t i : inside)
      result.values[i] = selected.values[i];
    return result;
  }();
  const Selection vessels = select(lungs, [](float value) { return value > 180.0F; });
  const Selection bone = select(fine, [](float value) { return value > 250.0F; });
  const double noise = estimateNoise(volume, Modality::ct);
  const double rawNoise = deviation(raw.minus(raw.blur(trend)), liver);
  const double rawVessels = mean(raw.topHat({3, 3, 1}), vessels), rawBone = mean(raw, bone);
  const Lesions lesions(volume.grid, selectInside(labels, 1.0F, 1.0F, 8));
  const Volume withLesions = lesions.addTo(volume);
  const Field3 added = toField(withLesions).minus(raw);
  std::cerr << "estimated noise " << noise << " HU, in the liver " << rawNoise << " HU\n";
  std::cout << "strength,noise,vessels,bone,lesion_4mm,lesion_6mm,lesion_8mm,lesion_12mm,"
               "lesion_20mm,cpu_seconds_per_32_megavoxels\n";
  for (const double strength : strengths) {
    const NonLocalMeans filter{noise, strength * noise};
    const double start = cpuSeconds();
    const Field3 smooth = toField(applyNonLocalMeans(volume, filter));
    const double seconds = cpuSeconds() - start;
    const Field3 change = toField(applyNonLocalMeans(withLesions, filter)).minus(smooth);
    std::cout << strength << ','
              << 100.0 * deviation(smooth.minus(smooth.blur(trend)), liver) / rawNoise << ','
              << 100.0 * mean(smooth.topHat({3, 3, 1}), vessels) / rawVessels << ','
              << 100.0 * mean(smooth, bone) / rawBone;
    for (const double diameter : Lesions::diameters)
      std::cout << ',' << 100.0 * lesions.contrast(diameter, added, change);
    std::cout << ',' << seconds * 32e6 / static_cast<double>(volume.grid.voxelCount()) << std::endl;
  }
}

} // namespace
} // namespace fenestra::core

int main(int argc, char** argv) {
  using namespace fenestra::core;
  const std::filesystem::path folder = std::filesystem::path(FENESTRA_DATA) / "torso_ct_ccth_a01";
  if (!std::filesystem::exists(folder)) {
    std::cerr << "SmoothingBenchmark: no data at " << folder << '\n';
    return 77;
  }
  std::vector<double> strengths;
  for (int i = 1; i < argc; ++i)
    strengths.push_back(std::stod(argv[i]));
  if (strengths.empty())
    strengths = {0.8, 0.9, 1.0, 1.1};
  if (const char* const set = std::getenv("FENESTRA_INSTRUCTIONS"))
    useInstructionSet(set);
  measure(readVolume(folder / "ct.nii.gz"),
          toField(readVolume(folder / "seg_totalsegmentator_rtstruct.nii.gz")), strengths);
}
