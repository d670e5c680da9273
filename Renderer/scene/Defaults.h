#pragma once
// Defaults of a scene: a look by modality and range, and a view that frames focus or volume.

#include "model/camera/Camera.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Domain.h"
#include "model/volume/Mask.h"
#include "model/volume/Volume.h"
#include "scene/AutomaticView.h"
#include "scene/RenderRequest.h"

namespace fenestra {

/// Name of a transfer preset for CT in Hounsfield units; nothing for any other volume.
std::optional<std::string> chooseTransferPreset(const Volume& volume);

/// True if a transfer function for `modality` can suit the volume: CT suits volumes in Hounsfield
/// units only, other modalities suit other volumes only.
bool canSuit(Modality modality, const Volume& volume);

/// Usual range of the voxels: percentiles 0.5 and 99.5, low < high. Constant volume: low = high.
std::array<double, 2> findRobustRange(const Volume& volume);

/// Scalar below which air lies around a body: -300 HU in CT, else Otsu's threshold (1979) of the
/// usual range. Nothing where a tenth of a volume other than CT has its least value: its
/// surroundings are cut off, such as the skull's around a brain, and what is left need not be a
/// body.
std::optional<double> findAirThreshold(const Volume& volume);

/// Share of the focus's voxels, 0 to 1, whose extinction is 0: a look that is made for something
/// else shows a hole where the focus is. From at most about a million voxels of the mask.
double transparentFraction(const Mask& focus, const Volume& volume,
                           const TransferFunction& transfer);

/// Look for volumes without an absolute scale (MR, ultrasound, stored values): from transparent
/// at the background's level to opaque at the 99.5th percentile, skin through tissue to ivory.
/// Extinction is relative to the volume's size. A constant volume gets a uniform haze without
/// shading.
TransferFunction makeRelativeTransfer(const Volume& volume);

/// Pose of a view request for this volume and focus: named views look along the patient's axes at
/// the focus with its surroundings, or at the part of the volume to frame where that is smaller. A
/// frame around a focus moves up or down from beyond an end of the scan, unless the request has a
/// target, a position or a scale.
/// `best`: direction for the name auto; null: anterior. Throws Error (usage) for an unknown view
/// name.
CameraPose frameView(const ViewRequest& view, const Domain& framed, const Mask* focus, int width,
                     int height, const ViewDirection* best = nullptr);

/// Scene's camera, changed by the set members of the request. Throws Error (usage) if --scale or
/// --angle belongs to the other projection.
CameraPose adjustView(const ViewRequest& view, const CameraPose& scene);

} // namespace fenestra
