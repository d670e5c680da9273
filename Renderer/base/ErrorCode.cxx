#include "base/ErrorCode.h"

#include <algorithm>
#include <array>
#include <utility>

namespace fenestra::core {
namespace {

constexpr auto words = [] {
  using enum ErrorCode;
  return std::to_array<std::pair<ErrorCode, std::string_view>>({
      {ambiguousName, "ambiguous-name"},
      {damagedFile, "damaged-file"},
      {invalidField, "invalid-field"},
      {invalidFile, "invalid-file"},
      {invalidValue, "invalid-value"},
      {limitExceeded, "limit-exceeded"},
      {missingFile, "missing-file"},
      {notAFile, "not-a-file"},
      {outOfMemory, "out-of-memory"},
      {outsideArchive, "outside-archive"},
      {outputConflict, "output-conflict"},
      {unknownName, "unknown-name"},
      {unreadableFile, "unreadable-file"},
      {unsupportedFile, "unsupported-file"},
      {unwritableFile, "unwritable-file"},
      {ambiguousSegmentation, "ambiguous-segmentation"},
      {ambiguousVolume, "ambiguous-volume"},
      {assumedForm, "assumed-form"},
      {assumedFrame, "assumed-frame"},
      {assumedGeometry, "assumed-geometry"},
      {assumedUnits, "assumed-units"},
      {ignoredRequest, "ignored-request"},
      {ignoredSceneSetting, "ignored-scene-setting"},
      {interpolatedSlices, "interpolated-slices"},
      {invalidSceneCamera, "invalid-scene-camera"},
      {missingTransferPoints, "missing-transfer-points"},
      {nonFiniteVoxels, "non-finite-voxels"},
      {omittedSlices, "omitted-slices"},
      {possibleHounsfieldOffset, "possible-hounsfield-offset"},
      {removedHounsfieldOffset, "removed-hounsfield-offset"},
      {removedTable, "removed-table"},
      {segmentationAsVolume, "segmentation-as-volume"},
      {segmentationRequired, "segmentation-required"},
      {spacingRequired, "spacing-required"},
      {uncertainTable, "uncertain-table"},
      {unknownForm, "unknown-form"},
      {unknownFrame, "unknown-frame"},
      {ambiguousPreset, "ambiguous-preset"},
      {conflictingLabels, "conflicting-labels"},
      {emptyFocus, "empty-focus"},
      {emptyShapedFocus, "empty-shaped-focus"},
      {focusRequired, "focus-required"},
      {largeShapedFocus, "large-shaped-focus"},
      {marginCount, "margin-count"},
      {noMatchingPreset, "no-matching-preset"},
      {noVoxelToColor, "no-voxel-to-color"},
      {tooManyMaterials, "too-many-materials"},
      {unknownLabelVersion, "unknown-label-version"},
      {unmatchedLabels, "unmatched-labels"},
      {unnamedSegments, "unnamed-segments"},
      {unusedLabels, "unused-labels"},
      {unusedSegmentation, "unused-segmentation"},
      {angleOfOrthographicCamera, "angle-of-orthographic-camera"},
      {emptyCrop, "empty-crop"},
      {emptyImagePlane, "empty-image-plane"},
      {excessiveExtinction, "excessive-extinction"},
      {focusOutsideImage, "focus-outside-image"},
      {hiddenFocus, "hidden-focus"},
      {implausibleModality, "implausible-modality"},
      {implausiblePresetModality, "implausible-preset-modality"},
      {invalidCamera, "invalid-camera"},
      {scaleOfPerspectiveCamera, "scale-of-perspective-camera"},
      {stopped, "stopped"},
      {tinyFocus, "tiny-focus"},
      {transparentFocus, "transparent-focus"},
      {uniformVolume, "uniform-volume"},
      {differentRun, "different-run"},
      {failedRows, "failed-rows"},
      {foreignOutput, "foreign-output"},
      {internal, "internal"},
      {staleFile, "stale-file"},
      {usage, "usage"},
  });
}();

} // namespace

std::string_view toString(ErrorCode code) {
  return std::ranges::find(words, code, &std::pair<ErrorCode, std::string_view>::first)->second;
}

} // namespace fenestra::core
