#pragma once
// Contents of an input, and the parts that a render would use: the report of `fenestra inspect`.

#include "scene/Input.h"

#include <nlohmann/json.hpp>

namespace fenestra {

/// Report as one JSON object. Lengths in mm, volumes of segments in ml, places in RAS, colours
/// display-encoded in [0, 1]; null: absent. Nodes refer to each other by id. Text is unchanged from
/// the files: printers have to escape control characters. The keys are stable:
///
///     input, kind ("scene" | "volume" | "segmentation" | "dicom"), version (of Slicer)
///     volumes [NODE]
///     segmentations [NODE + kind ("segmentation" | "labelMap" | "file"), shown, size, spacing,
///       segments [id, name, labelValue, layer, color, voxels, milliliters, bounds {lower, upper},
///       shown, material {name (null: a colour alone), kind ("tint" | "matter"), color (null: the
///       volume's own; what is seen, or [scalar, color] of each knot), priority, clip, density, why
///       (SegmentMaterials.h)}]]
///     volumeRenderings [NODE + volume, property, roi, cropping, followsDisplay, shown]
///     volumeProperties [NODE], rois [NODE]
///     views [NODE + layout, technique, background {bottom, top}]
///     cameras [NODE + layout, POSE unless the node has a problem]
///     transforms [NODE + linear, toWorld (row by row, with all transforms above)]
///     series [uid, number, description, modality, files]
///     others {tag: count}
///     materials [name, kind, color (as of a segment's material)]: the library
///     render: null (undecided what a render shows), or what one uses, as far as it can be read:
///       volume {id, name, size, spacing, center, voxelType, range, transforms [id, nearest
///       first]}, look {source ("volumeProperty" | "volumeDisplay" | "preset" | "range"), id,
///       name}, crop {id, name, edges, center}, camera {id, name, POSE}, background {view, bottom,
///       top}, segmentation (id or file that is searched for a focus), segmentationProblem (why it
///       is undecided), stored [argument stored in the scene by Fenestra's extension]
///     refused: null, or the line that a render ends in
///     warnings [line], ignored [line]
///
/// NODE: id, name, files [name (as in the scene, URL escapes decoded), there], transform (id of the
/// one right above), used (by a render), problem (null, or the line of the error on reading it).
/// POSE: projection, position, target, up, scale | angle.
using Inspection = nlohmann::ordered_json;

/// `input`: of request.input. Uses of the request only volume and segmentation. Reads the files
/// that a render would, and every segmentation, camera and transform (after 64 of a kind only
/// names). Throws Error if the input is neither scene nor volume nor segmentation.
Inspection inspectInput(const RenderRequest& request, const Input& input);

} // namespace fenestra
