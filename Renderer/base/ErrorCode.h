#pragma once
// One code per situation that a caller, a test or the program's advice distinguishes.

#include <cstdint>
#include <string_view>

namespace fenestra::core {

enum class ErrorCode : std::uint8_t {
  // Files, any field of a file, any part of a request
  ambiguousName,   ///< several things have it
  damagedFile,     ///< truncated, or not of its format
  invalidField,    ///< the subject names file and field
  invalidFile,     ///< its content contradicts itself or this use
  invalidValue,    ///< of a part of the request
  limitExceeded,   ///< more than this program accepts
  missingFile,     ///< or missing folder
  notAFile,        ///< a folder or a device
  outOfMemory,     ///< or no further process can start
  outsideArchive,  ///< a scene names a file that is not its own
  outputConflict,  ///< would replace an input or another result
  unknownName,     ///< of a file, preset, segment or node
  unreadableFile,  ///< permissions, disk
  unsupportedFile, ///< type or content that this program does not read or write
  unwritableFile,  ///< permissions, disk, name

  // Volumes and scenes
  ambiguousSegmentation, ///< the scene has several
  ambiguousVolume,       ///< the scene or folder has several
  assumedForm,           ///< warning: a NIfTI header has two that disagree
  assumedFrame,          ///< warning: the first of several
  assumedGeometry,       ///< warning: the file states no or contradictory positions
  assumedUnits,          ///< warning: of a PET
  ignoredRequest,        ///< warning: a stored part of the request is not used
  ignoredSceneSetting,   ///< warning: Slicer renders it differently
  interpolatedSlices,    ///< warning: DICOM slices are missing or unevenly spaced
  invalidSceneCamera,
  missingTransferPoints,    ///< of a volume property
  nonFiniteVoxels,          ///< warning
  omittedSlices,            ///< warning: of a DICOM series
  possibleHounsfieldOffset, ///< warning
  removedHounsfieldOffset,  ///< warning
  removedTable,             ///< warning: of the scanner
  segmentationAsVolume,
  segmentationRequired, ///< the request has a focus
  spacingRequired,      ///< of slices that state none
  uncertainTable,       ///< warning: the table of the scanner remains
  unknownForm,          ///< of a NIfTI header
  unknownFrame,

  // Segments and their names
  ambiguousPreset,
  conflictingLabels, ///< a table is requested, but the file names its segments
  emptyFocus,
  emptyShapedFocus, ///< after margins and smoothing
  focusRequired,
  largeShapedFocus, ///< with margins and smoothing
  marginCount,
  noMatchingPreset,
  noVoxelToColor,
  tooManyMaterials,
  unknownLabelVersion, ///< of TotalSegmentator
  unmatchedLabels,     ///< a requested table names no value of the file
  unnamedSegments,     ///< a segment is sought by name, and all have default names
  unusedLabels,        ///< warning: a table beside the file
  unusedSegmentation,  ///< warning: beside the volume

  // Views, clips and transfer functions
  angleOfOrthographicCamera,
  emptyCrop, ///< warning
  emptyImagePlane,
  excessiveExtinction,
  focusOutsideImage, ///< warning
  hiddenFocus,
  implausibleModality,       ///< warning: of the requested transfer function
  implausiblePresetModality, ///< warning
  invalidCamera,
  scaleOfPerspectiveCamera,
  stopped,          ///< on request, before there was a result
  tinyFocus,        ///< warning: too small in the image for a clipping surface
  transparentFocus, ///< warning
  uniformVolume,

  // Of the program
  differentRun,  ///< a stored result belongs to other options or files
  failedRows,    ///< of a table
  foreignOutput, ///< would replace a file that this program did not write
  internal,      ///< an unexpected exception
  staleFile,     ///< warning: of an earlier result
  usage,         ///< the command line is wrong
};

/// The code in words, like "missing-file".
std::string_view toString(ErrorCode code);

} // namespace fenestra::core
