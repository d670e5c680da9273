#pragma once
// Parts shared by the inspections of scenes and of plain files. For scene's own sources.

#include "base/Error.h"
#include "files/segments/SegmentationReader.h"
#include "session/Inspection.h"
#include "session/Scene.h"

#include <filesystem>
#include <memory>

namespace fenestra {

/// Result of `read`; nothing: `failure` holds the Error thrown.
template <typename Read>
auto attempted(Read&& read, std::optional<Error>& failure) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const Error& error) {
    failure = error;
    return std::nullopt;
  }
}

/// Result of `read`; nothing: `line` holds the line of the Error thrown.
template <typename Read>
auto attempted(Read&& read, std::string& line) -> std::optional<decltype(read())> {
  std::optional<Error> failure;
  auto result = attempted(read, failure);
  if (failure)
    line = failure->what();
  return result;
}

VolumeUse volumeUse(const Volume& volume);

/// Look of a volume without settings, by modality and range.
LookUse defaultLook(const Volume& volume);

/// Fills `summary` from the segmentation; segments without an entry in `shown` are shown.
void describe(const Segmentation& segmentation, const std::map<std::string, bool>& shown,
              SegmentationSummary& summary);

Inspection inspectScene(const SceneRequest& request);

} // namespace fenestra
