#pragma once
// Images of a sphere with depth, and what views with them show by arithmetic.

#include "ViewTest.h"
#include "vtkFenestraImageProp.h"

#include <vtkActor.h>
#include <vtkOpenGLRenderPass.h>
#include <vtkSphereSource.h>

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace image {

using views::Image;
using Point = std::array<double, 3>;

/// Red, green, blue and alpha, 0 to 255.
using Rgba = std::array<double, 4>;

constexpr Point center{5.0, 3.0, -4.0}; ///< of the sphere in the images, mm
constexpr double radius = 40.0;         ///< mm

constexpr Rgba background{51.0, 102.0, 204.0, 255.0};
/// Of translucent colors, which VTK blends in several steps with 8 and 16 bits.
constexpr double rounding = 2.0;

/// Counts the shader texts that VTK composes for a prop.
class BuildCounter : public vtkOpenGLRenderPass {
public:
  static BuildCounter* New();
  vtkTypeMacro(BuildCounter, vtkOpenGLRenderPass);
  void Attach(vtkProp* prop);
  void Render(const vtkRenderState* state) override;
  bool PreReplaceShaderValues(std::string& vertexShader, std::string& geometryShader,
                              std::string& fragmentShader, vtkAbstractMapper* mapper,
                              vtkProp* prop) override;
  vtkMTimeType GetShaderStageMTime() override;

  int Builds = 0;

protected:
  BuildCounter() { this->ActiveDrawBuffers = 1; }
};

/// A renderer that shows an image.
struct View {
  explicit View(vtkRenderWindow* window);
  void look(const Point& from, bool isParallel);

  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkFenestraImageProp> prop;
};

/// A sphere as VTK draws it.
struct Model {
  Model(const Point& center, double radius, double opacity = 1.0);

  vtkNew<vtkSphereSource> source;
  vtkNew<vtkActor> actor;
};

/// Depth of the analytic sphere at the center of a pixel, mm along the view axis; infinity: none.
double intersect(vtkRenderer* renderer, int width, int height, int column, int row);

/// Distance of a point from the analytic sphere's surface, mm.
double getDistance(const Point& point);

enum class Alpha {
  Hard, ///< 255 on the sphere, 0 beside it
  Soft  ///< 0 to 255 on the sphere, 255 in its middle
};
/// Image of the sphere by a renderer's camera. Colors differ from pixel to pixel, beside the
/// sphere, too.
std::shared_ptr<FenestraViewImage> trace(vtkRenderer* renderer, int width, int height, Alpha alpha);

/// Depths in the window's depth buffer, mm along the view axis, the upper row first; infinity:
/// nothing there.
std::vector<double> readDepths(vtkRenderWindow* window, vtkRenderer* renderer);

/// Colors and depths that a view of a size shows of an image, the upper row first.
struct Layer {
  std::vector<Rgba> colors; ///< straight alpha
  std::vector<double> depths;
};
/// By bilinear interpolation of premultiplied colors; depths of the nearest pixels that have one.
Layer enlarge(const FenestraViewImage& image, int width, int height);

Rgba getColor(const Image& image, std::size_t pixel);
Rgba blend(const Rgba& front, const Rgba& behind);

/// Colors of an image over one color.
std::vector<Rgba> compose(const Layer& layer, const Rgba& behind, double opacity = 1.0);

/// Pixels whose colors differ by more than a tolerance.
int countDifferent(const Image& found, const std::vector<Rgba>& expected, double tolerance);

class ImageProp : public views::ViewTest {
protected:
  /// Shows an image of the view as it is now. It is of the view's size, or a part of it.
  Layer show(View& view, Alpha alpha, int part = 1);
  /// Frame and depths without the image.
  std::pair<Image, std::vector<double>> renderModel(View& view);
};

} // namespace image
