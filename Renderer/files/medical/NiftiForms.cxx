#include "files/medical/NiftiForms.h"

#include "files/medical/MedicalImage.h"
#include "files/medical/NiftiSamples.h"

#include <algorithm>

namespace fenestra::core {
namespace {

/// Grid of the sform, then that of the qform; empty: they agree, or the image is not a volume.
std::vector<Grid> readDisagreeingForms(const std::filesystem::path& path) {
  const NiftiHeader header = readNiftiHeader(path);
  if (!header.qformToRas || header.size.size() < 3)
    return {};
  const Size3 size(header.size[0], header.size[1], header.size[2]);
  return {{size, header.indexToRas}, {size, *header.qformToRas}};
}

/// True if each corner of a grid is within half a voxel of a corner of the other: axes may have
/// another order or direction.
bool haveEqualCorners(const Grid& a, const Grid& b) {
  const double tolerance = 0.5 * a.spacing().minCoeff();
  for (int i = 0; i < 8; ++i) {
    double distance = infinity;
    for (int j = 0; j < 8; ++j)
      distance = std::min(distance, (a.worldCorner(i) - b.worldCorner(j)).norm());
    if (!(distance <= tolerance))
      return false;
  }
  return true;
}

} // namespace

std::vector<Grid> readPossibleGrids(const std::filesystem::path& path) {
  const auto format = findMedicalFormat(path);
  std::vector<Grid> grids;
  if (format == MedicalFormat::nifti)
    grids = readDisagreeingForms(path);
  if (format && grids.empty())
    readMedicalImage(path, Components::any,
                     [&](const MedicalImage& image, const SampleSource&) { grids = {image.grid}; });
  return grids;
}

void chooseNiftiForm(const std::filesystem::path& path,
                     const std::function<std::vector<Grid>()>& others, const std::string& name,
                     VolumeChoice& choice) {
  if (choice.niftiForm || findMedicalFormat(path) != MedicalFormat::nifti)
    return;
  try {
    const std::vector<Grid> forms = readDisagreeingForms(path);
    if (forms.empty())
      return;
    const std::vector<Grid> grids = others();
    const auto agrees = [&](const Grid& form) {
      return std::ranges::any_of(grids,
                                 [&](const Grid& other) { return haveEqualCorners(form, other); });
    };
    const bool sform = agrees(forms[0]), qform = agrees(forms[1]);
    if (sform == qform)
      return;
    choice.niftiForm = sform ? NiftiForm::sform : NiftiForm::qform;
    choice.formReason = name;
  } catch (const Error&) {
    return; // its reader reports it
  }
}

VolumeChoice chooseFormByVolume(const std::filesystem::path& path, const Grid* volume) {
  VolumeChoice choice;
  if (volume)
    chooseNiftiForm(
        path, [volume] { return std::vector{*volume}; }, "the volume", choice);
  return choice;
}

} // namespace fenestra::core
