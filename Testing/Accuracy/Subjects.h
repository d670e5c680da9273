#pragma once
// Who is looked at, and the executable's clipping surface of them.

#include "FocusField.h"
#include "Views.h"

#include <filesystem>
#include <string>

namespace fenestra::accuracy {

struct Subject {
  std::string name;
  std::filesystem::path input;    ///< what `fenestra` renders
  std::filesystem::path labelmap; ///< on the volume's grid
  std::string focus;              ///< as --focus has it
  int label;                      ///< in the labelmap
};

/// The knee that `fenestra phantom` makes, in a folder; `size` in voxels as its flag has it, or "".
Subject makeKnee(const std::filesystem::path& folder, const std::string& size);

Indicator readIndicator(const Subject& subject);

/// One of `count` views around the patient's superior axis, of the whole focus; the first is from
/// the front.
View viewAround(const FocusField& field, int number, int count, int size);

/// Depths at pixel centres, from `fenestra --clip surface --boundary …`; files go into `folder`.
std::vector<float> clipDepths(const Subject& subject, const View& view, const std::string& boundary,
                              const std::filesystem::path& folder);

} // namespace fenestra::accuracy
