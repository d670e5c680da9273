#include "fenestra/Volume.h"

#include "files/medical/VolumeReader.h"
#include "library/Convert.h"
#include "library/Data.h"

#include <algorithm>

namespace fenestra {
inline namespace v1 {
namespace {

constexpr std::pair<Modality, core::Modality> modalities[] = {
    {Modality::ct, core::Modality::ct},
    {Modality::mr, core::Modality::mr},
    {Modality::ultrasound, core::Modality::us},
    {Modality::pet, core::Modality::pt}};

core::Volume makeVolume(const Samples& samples, const Affine& indexToWorld,
                        const VolumeDescription& description) {
  const core::Grid grid = makeGrid(samples, indexToWorld, description.name);
  const core::SampleSource source = core::makeArraySource(toArray(samples, description.name));
  core::VoxelStore store(source.count);
  core::readSamples(source, store);
  core::Volume volume = core::makeVolume(description.name, grid, std::move(store));
  volume.hasContrastAgent = description.hasContrastAgent;
  for (const auto& [own, modality] : modalities)
    if (own == description.modality)
      volume.modality = modality;
  return volume;
}

} // namespace

core::SampleArray toArray(const Samples& samples, const std::string& subject) {
  if (!samples.data)
    throw core::inputError(core::ErrorCode::invalidField, subject, "has no samples");
  const core::SampleType type = toSampleType(samples.type);
  core::SampleArray array{
      .data = static_cast<const char*>(samples.data), .type = type, .isSwapped = samples.isSwapped};
  const bool isPacked = std::ranges::count(samples.strides, 0) == 3;
  auto packed = static_cast<std::int64_t>(core::bytesPerSample(type));
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    array.size[axis] = samples.size[i];
    array.steps[axis] = isPacked ? packed : samples.strides[i];
    packed *= samples.size[i];
  }
  return array;
}

core::Grid makeGrid(const Samples& samples, const Affine& indexToWorld,
                    const std::string& subject) {
  constexpr double mostVoxels = 0x1p40;
  double voxels = 1.0;
  for (const std::int64_t size : samples.size)
    voxels *= size > 0 ? static_cast<double>(size) : 2.0 * mostVoxels;
  if (voxels > mostVoxels)
    throw core::inputError(core::ErrorCode::invalidField, subject,
                           "must have at least one voxel along each axis, and at most 2^40 in all");
  const core::Affine map =
      core::checkAffine(toCoreAffine(indexToWorld), [&](const std::string& what) {
        return core::inputError(core::ErrorCode::invalidField, subject, "its affine ", what);
      });
  return {core::Size3(samples.size[0], samples.size[1], samples.size[2]), map};
}

Volume::Volume(const Samples& samples, const Affine& indexToWorld,
               const VolumeDescription& description)
    : m_data(guard([&] {
        return std::make_shared<const Data>(Data{std::make_shared<const core::VolumeInput>(
            core::VolumeInput{makeVolume(samples, indexToWorld, description)})});
      })) {}

Volume::Volume(std::shared_ptr<const Data> data) : m_data(std::move(data)) {}

std::array<std::int64_t, 3> Volume::size() const {
  const core::Size3& size = m_data->input->volume.grid.size;
  return {size.x(), size.y(), size.z()};
}

Affine Volume::indexToWorld() const {
  return toAffine(m_data->input->volume.grid.indexToWorld);
}

std::array<double, 2> Volume::range() const {
  return {m_data->input->volume.minimum, m_data->input->volume.maximum};
}

const std::string& Volume::name() const {
  return m_data->input->volume.name;
}

Modality Volume::modality() const {
  for (const auto& [own, modality] : modalities)
    if (m_data->input->volume.modality == modality)
      return own;
  return Modality::unknown;
}

std::vector<Warning> Volume::warnings() const {
  return toWarnings(m_data->input->volume.warnings);
}

Volume readVolume(const std::string& path, const ReadOptions& options) {
  return guard([&] {
    const auto reading = allowReading(options.isInProcess);
    return Volume(std::make_shared<const Volume::Data>(
        Volume::Data{core::Input(path).volume(makeChoice(options))}));
  });
}

} // namespace v1
} // namespace fenestra
