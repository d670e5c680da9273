#pragma once
// What the inspections of scenes and of plain files share. For scene's own sources.

#include "base/Error.h"
#include "files/segments/SegmentationReader.h"
#include "session/Inspection.h"
#include "session/Scene.h"

#include <filesystem>
#include <memory>

namespace fenestra {

/// What `read` returns, or nothing and the Error that it ended in.
template <typename Read>
auto attempted(Read&& read, std::optional<Error>& failure) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const Error& error) {
    failure = error;
    return std::nullopt;
  }
}

/// The same, with the Error's line.
template <typename Read>
auto attempted(Read&& read, std::string& line) -> std::optional<decltype(read())> {
  std::optional<Error> failure;
  auto result = attempted(read, failure);
  if (failure)
    line = failure->what();
  return result;
}

VolumeUse volumeUse(const Volume& volume);

/// By modality and range: what a volume gets that nobody set up.
LookUse defaultLook(const Volume& volume);

/// Fills in what it holds; segments are shown unless `shown` says otherwise.
void describe(const Segmentation& segmentation, const std::map<std::string, bool>& shown,
              SegmentationSummary& summary);

Inspection inspectScene(const SceneRequest& request);

} // namespace fenestra
