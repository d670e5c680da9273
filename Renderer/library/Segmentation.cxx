#include "fenestra/Segmentation.h"

#include "files/segments/MaskPacking.h"
#include "library/Convert.h"
#include "library/Data.h"

namespace fenestra {
inline namespace v1 {
namespace {

constexpr const char* inMemory = "segmentation"; ///< in messages

std::shared_ptr<const Segmentation::Data> share(core::Segmentation segmentation) {
  return std::make_shared<const Segmentation::Data>(Segmentation::Data{
      std::make_shared<const core::SegmentsInput>(core::SegmentsInput{std::move(segmentation)})});
}

core::Segmentation makeLabelMap(const Samples& labels, const Affine& indexToWorld,
                                const std::map<std::int32_t, std::string>& names) {
  core::LabelNames named;
  for (const auto& [value, name] : names)
    named[value] = {name};
  return core::makeLabelMap(inMemory, makeGrid(labels, indexToWorld, inMemory),
                            core::makeArraySource(toArray(labels, inMemory)), named);
}

core::Segmentation makeMasks(const std::vector<SegmentMask>& masks, const Affine& indexToWorld) {
  if (masks.empty())
    throw core::inputError(core::ErrorCode::invalidField, inMemory, "has no mask");
  std::vector<core::NamedMask> named;
  for (const SegmentMask& mask : masks) {
    const core::Grid grid = makeGrid(mask.samples, indexToWorld, mask.name);
    auto runs =
        core::readMaskRuns(core::makeArraySource(toArray(mask.samples, mask.name)), grid.size.x());
    if (!runs)
      throw core::inputError(core::ErrorCode::unsupportedFile, mask.name,
                             "is no mask: it has several values");
    named.push_back({{.id = mask.name,
                      .name = mask.name,
                      .labelValue = static_cast<std::int32_t>(named.size() + 1)},
                     {grid, std::move(*runs)}});
  }
  return core::packMasks(inMemory, std::move(named));
}

} // namespace

Segmentation::Segmentation(const Samples& labels, const Affine& indexToWorld,
                           const std::map<std::int32_t, std::string>& names)
    : m_data(guard([&] { return share(makeLabelMap(labels, indexToWorld, names)); })) {}

Segmentation::Segmentation(const std::vector<SegmentMask>& masks, const Affine& indexToWorld)
    : m_data(guard([&] { return share(makeMasks(masks, indexToWorld)); })) {}

Segmentation::Segmentation(std::shared_ptr<const Data> data) : m_data(std::move(data)) {}

std::vector<Segment> Segmentation::segments() const {
  return toSegments(m_data->input->segmentation.segments());
}

std::vector<Warning> Segmentation::warnings() const {
  return toWarnings(m_data->input->segmentation.warnings());
}

std::map<std::int32_t, std::string> readLabelNames(const std::string& table) {
  return guard([&] {
    const auto builtIn = core::findBuiltInLabelNames(table);
    std::map<std::int32_t, std::string> names;
    for (const auto& [value, name] : builtIn ? *builtIn : core::readLabelNames(table))
      names[value] = name.name;
    return names;
  });
}

Segmentation readSegmentation(const std::string& path, const std::optional<std::string>& labels,
                              const std::optional<Volume>& volume, const ReadOptions& options) {
  return guard([&] {
    const auto reading = allowReading(options.isInProcess);
    const core::Grid* const grid = volume ? &volume->data()->input->volume.grid : nullptr;
    return Segmentation(share(core::readSegmentation(path, grid, labels)));
  });
}

} // namespace v1
} // namespace fenestra
