#ifndef __FenestraHeightField_h
#define __FenestraHeightField_h

#include "FenestraViewCamera.h"
#include "FenestraViewImage.h"

#include <vtkBoundingBox.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

/// Surfaces of images of a camera, mm in world space.
namespace FenestraHeightField {

/// Triangles through the depths of about every fourth pixel of the view, with gaps where depths
/// jump.
vtkSmartPointer<vtkPolyData> Build(const FenestraViewImage& image,
                                   const FenestraViewCamera& camera);

/// Bounds of all pixels with a depth. Invalid: there are none.
vtkBoundingBox ComputeBounds(const FenestraViewImage& image, const FenestraViewCamera& camera);

} // namespace FenestraHeightField

#endif
