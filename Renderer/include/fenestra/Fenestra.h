#pragma once
// Fenestra's public interface: photorealistic rendering of medical volumes with an unobstructed
// view of the segments of interest.
//
//   fenestra::Scene scene = fenestra::readScene("ct.nii.gz", "organs.nii.gz", {}, {.focus =
//   {"liver"}}); fenestra::render(scene).save("liver.png");

#include "fenestra/ClipSurface.h"
#include "fenestra/Error.h"
#include "fenestra/Image.h"
#include "fenestra/Render.h"
#include "fenestra/Scene.h"
#include "fenestra/Segmentation.h"
#include "fenestra/Types.h"
#include "fenestra/Volume.h"
