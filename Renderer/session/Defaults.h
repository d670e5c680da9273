#pragma once
// What a scene gets where its user says nothing: a look by modality and range, and a view that
// frames what matters.

#include "model/camera/Camera.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Domain.h"
#include "model/volume/Mask.h"
#include "model/volume/Volume.h"
#include "session/AutomaticView.h"
#include "session/RenderRequest.h"

namespace fenestra {

/// The name of a transfer preset for CT in Hounsfield units, nothing for any other volume.
std::optional<std::string> transferPresetFor(const Volume& volume);

/// Whether a transfer function for that modality can suit the volume: one of Hounsfield units does
/// not suit others, nor the other way round.
bool suits(Modality modality, const Volume& volume);

/// The least and greatest value that are usual: percentiles 0.5 and 99.5 of the voxels; low < high
/// but for a constant volume.
std::array<double, 2> usualRange(const Volume& volume);

/// A look for volumes without an absolute scale (MR, ultrasound, stored values): from transparent
/// at the background's level to opaque at the 99.5th percentile, dark red-brown through tissue to
/// ivory. Extinction is relative to the volume's size. A constant volume gets a uniform haze
/// without shading.
TransferFunction relativeTransfer(const Volume& volume);

/// The pose that a view request means for this volume and focus: named views look along the
/// patient's axes at the focus (else the volume, or what a crop leaves of it), and what is framed
/// is the focus with its surroundings. `automatic` is what the name auto means. Throws Error
/// (usage) for an unknown view name.
CameraPose frameView(const ViewRequest& view, const Domain& domain, const Mask* focus, int width,
                     int height, const std::optional<ViewDirection>& automatic = {});

/// A scene's camera with what the request states of it. Throws Error (usage) where --scale or
/// --angle is for the other projection.
CameraPose adjustedView(const ViewRequest& view, const CameraPose& scene);

} // namespace fenestra
