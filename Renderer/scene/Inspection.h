#pragma once
// The report of `fenestra inspect`: the contents of an input, and what a render would use of it.

#include "scene/Input.h"

#include <nlohmann/json.hpp>

namespace fenestra::core {

/// The report, one JSON object. Lengths are in mm, segment volumes in ml, positions in RAS, and
/// colors are display-encoded in [0, 1]. Absent values are null. Nodes refer to each other by id.
/// Strings are copied from the files unchanged: escape control characters before printing them. The
/// keys are stable:
///
///     input, kind ("scene" | "volume" | "segmentation" | "dicom"), version (of Slicer)
///     volumes [NODE]
///     segmentations [NODE + kind ("segmentation" | "labelMap" | "file"), shown, size, spacing,
///       segments [id, name, labelValue, layer, color, voxels, milliliters, bounds {lower, upper},
///       shown, material {name (null: only a color), kind ("tint" | "matter"), color (null: the
///       volume's own; else the reflected color, or [scalar, color] per knot), priority, clip,
///       density, why (SegmentMaterials.h)}]]
///     volumeRenderings [NODE + volume, property, roi, cropping, followsDisplay, shown]
///     volumeProperties [NODE], rois [NODE]
///     views [NODE + layout, technique, background {bottom, top}]
///     cameras [NODE + layout, POSE unless the node has a problem]
///     transforms [NODE + linear, toWorld (row-major, including all parent transforms)]
///     series [uid, number, description, modality, part (like "echo 4.9 ms"), frames, files]
///     others {tag: count}
///     materials [name, kind, color (like a segment's material)]: the library
///     examples [volume, choice (of a series or node, or null), segmentation (file or node, or
///       null), focus (segment, or null), spacing ("X,Y,Z" in mm, or null)]: renders
///     render: null if the choice of nodes is ambiguous, else what a render uses, with null for
///       unreadable parts: volume {id, name, size, spacing, center, voxelType, range, frames,
///       transforms [id, innermost first]}, look {source ("volumeProperty" | "volumeDisplay" |
///       "preset" | "range"), id, name}, crop {id, name, edges, center}, camera {id, name, POSE},
///       background {view, bottom, top}, segmentation (id or file in which a focus is searched),
///       segmentationProblem (why it is ambiguous), stored [option stored in the scene by
///       Fenestra's extension]
///     refused: null, or the error message of a render
///     warnings [message], ignored [line]
///
/// NODE: id, name, files [name (as in the scene, URL-decoded), there], transform (id of its parent
/// transform), used (by a render), problem (null, or the error message from reading it).
/// POSE: projection, position, target, up, scale | angle.
using Inspection = nlohmann::ordered_json;

/// Messages in a report, which the program turns into lines: {"code", "subject", "detail"}.
void to_json(nlohmann::ordered_json& json, const Message& message);
void from_json(const nlohmann::ordered_json& json, Message& message);

/// `input`: of request.input. Of the request, only volume, segmentation and labels are used. Reads
/// the files that a render would read, and all segmentations, cameras and transforms (names only
/// after the first 64 of a kind). Throws Error if the input is no scene, volume or segmentation.
Inspection inspectInput(const RenderRequest& request, const Input& input);

} // namespace fenestra::core
