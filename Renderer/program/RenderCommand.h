#pragma once
// From a request to its results, for the commands that write a picture.

#include "program/Checkpoint.h"

namespace fenestra {

/// Renders the scene, from `checkpoint` on if there is one, puts its pictures in place, then
/// measures them for the statistics; of a part, puts its film in place. `words`: arguments of the
/// process, for the pictures' headers. Returns the exit status.
int renderScene(const PictureRequest& request, const std::vector<std::string>& words,
                std::optional<Checkpoint>& checkpoint, Outputs& outputs);

} // namespace fenestra
