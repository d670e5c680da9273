#pragma once
// Output of `fenestra inspect`.

#include "session/Inspection.h"

#include <string>

namespace fenestra {

/// Lines of at most 100 characters; a list that is cut says how much is missing.
std::string inspectionText(const Inspection& inspection, const std::string& input);

/// One JSON document with the whole inspection. Lengths in mm, volumes of segments in ml, places in
/// RAS, colours display-encoded in [0, 1]; null: absent. The keys are stable:
///
///     input, kind ("scene" | "volume" | "segmentation" | "dicom"), version
///     volumes [NODE]
///     segmentations [NODE + kind ("segmentation" | "labelMap" | "file"), shown, size, spacing,
///       segments [id, name, labelValue, layer, color, voxels, milliliters, bounds {lower, upper},
///       shown]]
///     volumeRenderings [NODE + volume, property, roi, cropping, followsDisplay, shown]
///     volumeProperties [NODE], rois [NODE]
///     views [NODE + layout, technique, background {bottom, top}]
///     cameras [NODE + layout, projection, position, target, up, scale | angle]
///     transforms [NODE + linear, toWorld (row by row)]
///     series [uid, number, description, modality, files]
///     others {tag: count}
///     render: null, or volume {id, name, size, spacing, center, voxelType, range, transforms
///     [id]},
///       look {source ("volumeProperty" | "volumeDisplay" | "preset" | "range"), id, name},
///       crop {id, name, edges, center}, camera {id, name, projection, ...}, background {view,
///       bottom, top}, segmentation, segmentationProblem, stored [argument]
///     refused: null, or the line that a render ends in
///     warnings [line], ignored [line]
///
/// where NODE is id, name, files [name, there], transform (id), used, problem (null, or a line).
std::string inspectionJson(const Inspection& inspection, const std::string& input);

} // namespace fenestra
