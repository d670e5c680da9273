#ifndef __FenestraViewCamera_h
#define __FenestraViewCamera_h

#include <array>
#include <optional>

class vtkRenderer;

/// What decides which point of the world a pixel of a view shows. mm in world space.
struct FenestraViewCamera {
  using Point = std::array<double, 3>;

  Point position, focalPoint, viewUp;
  bool isParallel;
  double viewAngle;     ///< vertical, degrees; perspective only
  double parallelScale; ///< half the height of the view, mm; parallel projection only
  std::array<double, 2> windowCenter;
  int width, height; ///< of the view, pixels

  /// A renderer's active camera. Nothing: the renderer has no camera or no size, or the camera has
  /// no direction, an off-axis projection, a horizontal view angle, a user transform or two eyes.
  static std::optional<FenestraViewCamera> FromRenderer(vtkRenderer* renderer);

  /// Tolerates rounding: vtkWindowToImageFilter stores the view angle as float.
  bool IsSame(const FenestraViewCamera& other) const;
};

/// Points of the world in a view.
class FenestraViewRays {
public:
  explicit FenestraViewRays(const FenestraViewCamera& camera);

  /// A position in the view, 0 to 1 from the upper left corner, at a depth along the view axis, mm.
  FenestraViewCamera::Point ToWorld(double x, double y, double depth) const;
  /// Height of the view at a depth, mm.
  double GetHeight(double depth) const;

private:
  FenestraViewCamera::Point Origin, Right, Up, Forward;
  std::array<double, 2> Center;
  bool IsParallel;
  double HalfHeight; ///< mm, in perspective at a depth of 1 mm
  double Aspect;
};

#endif
