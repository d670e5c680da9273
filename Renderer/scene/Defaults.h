#pragma once
// Scene defaults: measures of a volume's values, and a camera that frames the focus or the volume.
// DefaultTransfer.h chooses the transfer function.

#include "model/camera/Camera.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Domain.h"
#include "model/volume/Mask.h"
#include "model/volume/Volume.h"
#include "scene/AutomaticView.h"
#include "scene/RenderRequest.h"

namespace fenestra::core {

/// True if a transfer function for `modality` is plausible for the volume: it is the modality that
/// the file states; else CT requires a volume in Hounsfield units, and all other modalities one
/// that is not.
bool isPlausibleModality(Modality modality, const Volume& volume);

/// Values of at most about a million voxels, distributed over the volume.
std::vector<double> sampleValues(const Volume& volume);
/// Values at at most about a million voxels of a mask, those inside its surface and the volume.
std::vector<double> sampleValues(const Volume& volume, const Mask& mask);

/// Otsu's threshold (1979) of sampled values, from a 256-bin histogram of [low, high].
double otsuThreshold(const Volume& volume, double low, double high);

/// Robust scalar range: percentiles 0.5 and 99.5, low < high. Constant volume: low = high.
std::array<double, 2> findRobustRange(const Volume& volume);

/// Threshold that separates a body from the surrounding air: -300 HU in CT, else Otsu's threshold
/// (1979) within the robust range. Empty if a tenth of a volume other than CT has the minimum
/// value: such a volume is masked, for example by skull stripping, and may lack the body surface.
std::optional<double> findAirThreshold(const Volume& volume);

/// Fraction of the focus voxels, 0 to 1, with zero extinction: a high value means an unsuitable
/// transfer function.
double transparentFraction(const Mask& focus, const Volume& volume,
                           const TransferFunction& transfer);

/// Camera pose of a view request for this volume and focus. Named views look along the patient's
/// axes. They frame the focus and its surroundings, or `framed` if that is smaller. If the frame
/// around a focus extends beyond an end of the scan, it is moved up or down, unless the request
/// sets the target, position or scale.
/// `best`: direction of the view "auto"; null: anterior. Throws Error (request) for an unknown view
/// name.
CameraPose frameView(const ViewRequest& view, const Domain& framed, const Mask* focus, int width,
                     int height, const ViewDirection* best = nullptr);

/// The scene's camera with the set members of the request. Throws Error (request) if --scale or
/// --angle belongs to the other projection.
CameraPose adjustView(const ViewRequest& view, const CameraPose& scene);

} // namespace fenestra::core
