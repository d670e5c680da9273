#include "scene/LungSegment.h"

#include "model/filtering/Lungs.h"
#include "scene/Defaults.h"

namespace fenestra::core {

bool needsLungs(const RenderRequest& request) {
  return request.transfer == lungTransfer && request.focus.empty() && !request.clip.mode &&
         request.materials.value_or(noMaterials) == noMaterials;
}

FoundLungs findLungSegment(const VolumeHandle& read) {
  const Volume& volume = read->volume;
  std::optional<Lungs> lungs;
  if (isPlausibleModality(Modality::ct, volume))
    lungs = findLungs(volume);
  FoundLungs found;
  if (!lungs) {
    found.warnings.push_back(makeMessage(ErrorCode::emptyFocus, volume.name,
                                         "has no lungs that are found without a segmentation"));
    return found;
  }
  found.volume = lungs->volume;
  const std::string source = concat("lungs found in ", volume.name);
  Segmentation::Labels labels = LargeArray<std::uint8_t>(lungs->marks.begin(), lungs->marks.end());
  found.input = std::make_shared<const SegmentsInput>(SegmentsInput{Segmentation(
      source, lungs->grid, 1, std::move(labels), {{.id = lungSegment, .name = lungSegment}})});
  return found;
}

} // namespace fenestra::core
