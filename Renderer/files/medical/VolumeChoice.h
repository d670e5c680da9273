#pragma once
// Which volume to read, where an input holds several, or places one in two ways.

#include "base/Error.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace fenestra {

/// The two index-to-world transforms of a NIfTI header.
enum class NiftiForm { qform, sform };

struct VolumeChoice {
  std::optional<std::string> name = {};    ///< node of a scene, or series of a DICOM folder
  std::optional<std::size_t> frame = {};   ///< time of a series or 4D file; empty: the first
  std::optional<NiftiForm> niftiForm = {}; ///< empty: by the rule of NiftiHeader.h
  std::string formReason = {}; ///< whose grid only that form agrees with; empty: the user's choice

  bool operator==(const VolumeChoice&) const = default;
};

/// Returns the frame to read of `count`. Adds a warning if there are several and none was chosen.
/// Throws Error (input) if there is no such frame. `subject` is used in messages.
std::size_t chooseFrame(const std::string& subject, std::optional<std::size_t> frame,
                        std::size_t count, std::vector<Message>& warnings);

} // namespace fenestra
