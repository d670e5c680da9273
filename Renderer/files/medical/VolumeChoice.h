#pragma once
// Which volume to read, where an input holds several, or places one in two ways.

#include "base/Error.h"
#include "base/Vector.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace fenestra::core {

/// The two index-to-world transforms of a NIfTI header.
enum class NiftiForm { qform, sform };

struct VolumeChoice {
  std::optional<std::string> name = {};    ///< node of a scene, or series of a DICOM folder
  std::optional<std::size_t> frame = {};   ///< time of a series or 4D file; empty: the first
  std::optional<NiftiForm> niftiForm = {}; ///< empty: by the rule of NiftiHeader.h
  std::string formReason = {}; ///< whose grid only that form agrees with; empty: the user's choice
  std::optional<Vec3> spacing = {}; ///< mm along x, y, z; only for an input that states none

  bool operator==(const VolumeChoice&) const = default;
};

/// Returns the frame to read of `count`. Adds a warning if there are several and none was chosen.
/// Throws Error (input) if there is no such frame. `subject` is used in messages.
std::size_t chooseFrame(const std::string& subject, std::optional<std::size_t> frame,
                        std::size_t count, std::vector<Message>& warnings);

/// Throws Error (input) if the choice has a NIfTI form: the input has none.
void refuseForm(const std::string& subject, const VolumeChoice& choice);

/// Throws Error (input) if the choice has a spacing: the input states its own.
void refuseSpacing(const std::string& subject, const VolumeChoice& choice);

} // namespace fenestra::core
