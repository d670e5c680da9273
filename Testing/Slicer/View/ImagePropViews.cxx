#include "ImagePropViews.h"

#include <vtkCamera.h>
#include <vtkFloatArray.h>
#include <vtkInformation.h>
#include <vtkInformationObjectBaseVectorKey.h>
#include <vtkMatrix4x4.h>
#include <vtkObjectFactory.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace image {

vtkStandardNewMacro(BuildCounter);

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Point subtract(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// Normalized device coordinates to world space by VTK's own matrices, mm.
Point unproject(vtkRenderer* renderer, double aspect, const Point& point) {
  const vtkNew<vtkMatrix4x4> matrix;
  matrix->DeepCopy(
      renderer->GetActiveCamera()->GetCompositeProjectionTransformMatrix(aspect, -1.0, 1.0));
  matrix->Invert();
  const double device[4] = {point[0], point[1], point[2], 1.0};
  double world[4];
  matrix->MultiplyPoint(device, world);
  return {world[0] / world[3], world[1] / world[3], world[2] / world[3]};
}

unsigned char toByte(double value) {
  return static_cast<unsigned char>(std::lround(std::clamp(value, 0.0, 255.0)));
}

} // namespace

void BuildCounter::Attach(vtkProp* prop) {
  const vtkNew<vtkInformation> keys;
  keys->Append(vtkOpenGLRenderPass::RenderPasses(), this);
  prop->SetPropertyKeys(keys);
}

void BuildCounter::Render(const vtkRenderState* /*state*/) {}

bool BuildCounter::PreReplaceShaderValues(std::string& /*vertexShader*/,
                                          std::string& /*geometryShader*/,
                                          std::string& /*fragmentShader*/,
                                          vtkAbstractMapper* /*mapper*/, vtkProp* /*prop*/) {
  ++this->Builds;
  return true;
}

vtkMTimeType BuildCounter::GetShaderStageMTime() {
  return 1;
}

View::View(vtkRenderWindow* window) {
  this->renderer->SetBackground(51.0 / 255.0, 102.0 / 255.0, 204.0 / 255.0);
  window->AddRenderer(this->renderer);
  this->look({20.0, -300.0, 60.0}, false);
  this->prop->SetRenderer(this->renderer);
}

void View::look(const Point& from, bool isParallel) {
  vtkCamera* camera = this->renderer->GetActiveCamera();
  camera->SetPosition(from.data());
  camera->SetFocalPoint(10.0, 0.0, 0.0);
  camera->SetViewUp(0.1, 0.2, 1.0);
  camera->SetViewAngle(20.0);
  camera->SetParallelScale(55.0);
  camera->SetParallelProjection(isParallel ? 1 : 0);
  camera->SetClippingRange(100.0, 600.0);
}

Model::Model(const Point& at, double size, double opacity) {
  this->source->SetCenter(at[0], at[1], at[2]);
  this->source->SetRadius(size);
  this->source->SetThetaResolution(80);
  this->source->SetPhiResolution(60);
  const vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(this->source->GetOutputPort());
  this->actor->SetMapper(mapper);
  vtkProperty* property = this->actor->GetProperty();
  property->SetColor(1.0, 0.8, 0.0);
  property->SetOpacity(opacity);
  if (opacity < 1.0) { // one layer of one color
    property->LightingOff();
    property->BackfaceCullingOn();
  }
}

double intersect(vtkRenderer* renderer, int width, int height, int column, int row) {
  const double aspect = renderer->GetTiledAspectRatio();
  const double x = 2.0 * (column + 0.5) / width - 1.0, y = 1.0 - 2.0 * (row + 0.5) / height;
  const Point start = unproject(renderer, aspect, {x, y, -1.0});
  const Point direction = subtract(unproject(renderer, aspect, {x, y, 1.0}), start);
  const Point offset = subtract(start, center);
  const double a = dot(direction, direction), b = dot(direction, offset);
  const double discriminant = b * b - a * (dot(offset, offset) - radius * radius);
  if (discriminant < 0.0)
    return infinity;
  const double t = (-b - std::sqrt(discriminant)) / a;
  Point position, axis;
  renderer->GetActiveCamera()->GetPosition(position.data());
  renderer->GetActiveCamera()->GetDirectionOfProjection(axis.data());
  return dot(subtract(start, position), axis) + t * dot(direction, axis);
}

double getDistance(const Point& point) {
  const Point offset = subtract(point, center);
  return std::abs(std::sqrt(dot(offset, offset)) - radius);
}

std::shared_ptr<FenestraViewImage> trace(vtkRenderer* renderer, int width, int height,
                                         Alpha alpha) {
  auto image = std::make_shared<FenestraViewImage>();
  image->width = width;
  image->height = height;
  double nearest = infinity;
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const double depth = intersect(renderer, width, height, column, row);
      image->depth.push_back(static_cast<float>(depth));
      nearest = std::min(nearest, depth);
    }
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const double depth = static_cast<double>(image->depth[image->GetIndex(column, row)]);
      const double soft = 300.0 * (1.0 - (depth - nearest) / radius);
      for (const int value : {37 * column + 11 * row, 5 * column + 91 * row, 61 * column * row})
        image->rgba.push_back(static_cast<unsigned char>(value % 256));
      image->rgba.push_back(std::isfinite(depth) ? toByte(alpha == Alpha::Hard ? 255.0 : soft)
                                                 : std::uint8_t{0});
    }
  return image;
}

std::vector<double> readDepths(vtkRenderWindow* window, vtkRenderer* renderer) {
  int width = 0, height = 0, left = 0, bottom = 0;
  renderer->GetTiledSizeAndOrigin(&width, &height, &left, &bottom);
  const vtkNew<vtkFloatArray> values;
  window->GetZbufferData(left, bottom, left + width - 1, bottom + height - 1, values);
  vtkCamera* camera = renderer->GetActiveCamera();
  double range[2];
  camera->GetClippingRange(range);
  std::vector<double> depths;
  for (int row = height - 1; row >= 0; --row)
    for (int column = 0; column < width; ++column) {
      const auto value =
          static_cast<double>(values->GetValue(static_cast<vtkIdType>(row) * width + column));
      const double mm = camera->GetParallelProjection()
                            ? range[0] + value * (range[1] - range[0])
                            : range[0] * range[1] / (range[1] - value * (range[1] - range[0]));
      depths.push_back(value < 1.0 ? mm : infinity);
    }
  return depths;
}

Layer enlarge(const FenestraViewImage& image, int width, int height) {
  Layer layer;
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const double x = (column + 0.5) * image.width / width - 0.5;
      const double y = (row + 0.5) * image.height / height - 0.5;
      Rgba sum{};
      double depth = infinity, largest = 0.0;
      for (int i = 0; i < 4; ++i) {
        const double left = std::floor(x) + i % 2, top = std::floor(y) + i / 2;
        const double weight = (1.0 - std::abs(x - left)) * (1.0 - std::abs(y - top));
        const std::size_t at =
            image.GetIndex(std::clamp(static_cast<int>(left), 0, image.width - 1),
                           std::clamp(static_cast<int>(top), 0, image.height - 1));
        const double alpha = weight * image.rgba[4 * at + 3];
        for (std::size_t k = 0; k < 3; ++k)
          sum[k] += alpha * image.rgba[4 * at + k];
        sum[3] += alpha;
        if (std::isfinite(image.depth[at]) && weight > largest) {
          depth = static_cast<double>(image.depth[at]);
          largest = weight;
        }
      }
      for (std::size_t k = 0; k < 3 && sum[3] > 0.0; ++k)
        sum[k] /= sum[3];
      layer.colors.push_back(sum);
      layer.depths.push_back(depth);
    }
  return layer;
}

Rgba getColor(const Image& image, std::size_t pixel) {
  const unsigned char* first = &image.colors[3 * pixel];
  return {static_cast<double>(first[0]), static_cast<double>(first[1]),
          static_cast<double>(first[2]), 255.0};
}

Rgba blend(const Rgba& front, const Rgba& behind) {
  const double alpha = front[3] / 255.0;
  Rgba color{0.0, 0.0, 0.0, 255.0};
  for (std::size_t k = 0; k < 3; ++k)
    color[k] = alpha * front[k] + (1.0 - alpha) * behind[k];
  return color;
}

std::vector<Rgba> compose(const Layer& layer, const Rgba& behind, double opacity) {
  std::vector<Rgba> colors;
  for (Rgba color : layer.colors) {
    color[3] *= opacity;
    colors.push_back(blend(color, behind));
  }
  return colors;
}

int countDifferent(const Image& found, const std::vector<Rgba>& expected, double tolerance) {
  int different = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Rgba color = getColor(found, i);
    double largest = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
      largest = std::max(largest, std::abs(color[k] - expected[i][k]));
    different += largest > tolerance ? 1 : 0;
  }
  return different;
}

Layer ImageProp::show(View& view, Alpha alpha, int part) {
  this->render(view.renderer); // gives the view its size
  int width = 0, height = 0;
  view.renderer->GetTiledSize(&width, &height);
  const auto traced = trace(view.renderer, width / part, height / part, alpha);
  view.prop->SetImage(traced);
  return enlarge(*traced, width, height);
}

std::pair<Image, std::vector<double>> ImageProp::renderModel(View& view) {
  view.prop->VisibilityOff();
  Image frame = this->render(view.renderer);
  view.prop->VisibilityOn();
  return {frame, readDepths(this->window, view.renderer)};
}

} // namespace image
