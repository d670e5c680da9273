#include "FenestraViewCamera.h"

#include <vtkCamera.h>
#include <vtkMath.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace {
using Point = FenestraViewCamera::Point;

Point Subtract(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double GetLength(const Point& a) {
  return std::hypot(a[0], a[1], a[2]);
}

/// Cross product of unit length. NaN for parallel vectors.
Point MakeNormal(const Point& a, const Point& b) {
  Point normal;
  vtkMath::Cross(a.data(), b.data(), normal.data());
  const double length = GetLength(normal);
  return {normal[0] / length, normal[1] / length, normal[2] / length};
}

bool IsNear(double a, double b, double tolerance) {
  return std::abs(a - b) <= tolerance * std::max(std::abs(a), std::abs(b));
}

bool IsNear(const Point& a, const Point& b, double mm) {
  return GetLength(Subtract(a, b)) <= mm;
}
} // namespace

std::optional<FenestraViewCamera> FenestraViewCamera::FromRenderer(vtkRenderer* renderer) {
  // The renderer creates a missing camera when it is asked for it.
  if (!renderer || !renderer->IsActiveCameraCreated() || !renderer->GetRenderWindow())
    return std::nullopt;
  vtkCamera* camera = renderer->GetActiveCamera();
  if (camera->GetUseOffAxisProjection() || camera->GetUseHorizontalViewAngle() ||
      camera->GetUserTransform() || camera->GetUserViewTransform() ||
      renderer->GetRenderWindow()->GetStereoRender())
    return std::nullopt;
  FenestraViewCamera view{};
  camera->GetPosition(view.position.data());
  camera->GetFocalPoint(view.focalPoint.data());
  camera->GetViewUp(view.viewUp.data());
  camera->GetWindowCenter(view.windowCenter.data());
  view.isParallel = camera->GetParallelProjection() != 0;
  view.viewAngle = camera->GetViewAngle();
  view.parallelScale = camera->GetParallelScale();
  renderer->GetTiledSize(&view.width, &view.height);
  Point normal;
  vtkMath::Cross(Subtract(view.focalPoint, view.position).data(), view.viewUp.data(),
                 normal.data());
  if (view.width <= 0 || view.height <= 0 || !(GetLength(normal) > 0.0))
    return std::nullopt;
  return view;
}

bool FenestraViewCamera::IsSame(const FenestraViewCamera& other) const {
  constexpr double tolerance = 1e-9, floatTolerance = 1e-6;
  const double mm = tolerance * GetLength(Subtract(this->focalPoint, this->position));
  return this->width == other.width && this->height == other.height &&
         this->isParallel == other.isParallel && IsNear(this->position, other.position, mm) &&
         IsNear(this->focalPoint, other.focalPoint, mm) &&
         IsNear(this->viewUp, other.viewUp, tolerance * GetLength(this->viewUp)) &&
         std::abs(this->windowCenter[0] - other.windowCenter[0]) <= tolerance &&
         std::abs(this->windowCenter[1] - other.windowCenter[1]) <= tolerance &&
         (this->isParallel ? IsNear(this->parallelScale, other.parallelScale, floatTolerance)
                           : IsNear(this->viewAngle, other.viewAngle, floatTolerance));
}

FenestraViewRays::FenestraViewRays(const FenestraViewCamera& camera)
    : Origin(camera.position),
      IsParallel(camera.isParallel),
      HalfHeight(camera.isParallel ? camera.parallelScale
                                   : std::tan(0.5 * vtkMath::RadiansFromDegrees(camera.viewAngle))),
      Aspect(static_cast<double>(camera.width) / camera.height) {
  const Point direction = Subtract(camera.focalPoint, camera.position);
  this->Right = MakeNormal(direction, camera.viewUp);
  this->Up = MakeNormal(this->Right, direction);
  this->Forward = MakeNormal(this->Up, this->Right);
  this->Center = camera.windowCenter;
}

double FenestraViewRays::GetHeight(double depth) const {
  return 2.0 * this->HalfHeight * (this->IsParallel ? 1.0 : depth);
}

FenestraViewCamera::Point FenestraViewRays::ToWorld(double x, double y, double depth) const {
  const double halfHeight = 0.5 * this->GetHeight(depth);
  const double right = (2.0 * x - 1.0 + this->Center[0]) * halfHeight * this->Aspect;
  const double up = (1.0 - 2.0 * y + this->Center[1]) * halfHeight;
  Point point;
  for (std::size_t i = 0; i < 3; ++i)
    point[i] =
        this->Origin[i] + right * this->Right[i] + up * this->Up[i] + depth * this->Forward[i];
  return point;
}
