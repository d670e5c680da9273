#include "OpeningPassViews.h"

#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkColorTransferFunction.h>
#include <vtkObjectFactory.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPolyData.h>
#include <vtkShaderProgram.h>
#include <vtkSphereSource.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace opening {

vtkStandardNewMacro(DepthPass);

namespace {

using fenestra::core::DepthMap;
using fenestra::core::SampleGrid;
using fenestra::core::SurfaceTriangles;

constexpr float infinity = std::numeric_limits<float>::infinity();

std::array<double, 3> transform(const vtkMatrix4x4* matrix, double x, double y, double z) {
  const double point[4] = {x, y, z, 1.0};
  double moved[4];
  const_cast<vtkMatrix4x4*>(matrix)->MultiplyPoint(point, moved);
  return {moved[0], moved[1], moved[2]};
}

/// Rotation about (1, 2, 3) by an angle in degrees, and a translation in mm.
void setTransform(vtkMatrix4x4* matrix, double degrees, const std::array<double, 3>& mm) {
  const double angle = degrees * 3.14159265358979323846 / 180.0, norm = std::sqrt(14.0);
  const double c = std::cos(angle), s = std::sin(angle);
  const double axis[3] = {1.0 / norm, 2.0 / norm, 3.0 / norm};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const int other = 3 - row - column;
      const double sign = (column - row + 3) % 3 == 1 ? -1.0 : 1.0;
      matrix->SetElement(row, column,
                         axis[row] * axis[column] * (1.0 - c) +
                             (row == column ? c : sign * s * axis[other]));
    }
    matrix->SetElement(row, 3, mm[static_cast<std::size_t>(row)]);
  }
}

std::shared_ptr<const ClosedSurface> makeEllipsoid(const std::array<double, 3>& center) {
  vtkNew<vtkSphereSource> sphere;
  sphere->SetRadius(1.0);
  sphere->SetThetaResolution(60);
  sphere->SetPhiResolution(40);
  sphere->Update();
  vtkNew<vtkMatrix4x4> rotation;
  setTransform(rotation, 70.0, center);
  SurfaceTriangles triangles;
  vtkPolyData* mesh = sphere->GetOutput();
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i) {
    const double* p = mesh->GetPoint(i);
    for (const double coordinate : transform(rotation, 15.0 * p[0], 10.0 * p[1], 7.0 * p[2]))
      triangles.points.push_back(static_cast<float>(coordinate));
  }
  vtkCellArray* cells = mesh->GetPolys();
  vtkIdType count = 0;
  const vtkIdType* points = nullptr;
  for (cells->InitTraversal(); cells->GetNextCell(count, points);)
    for (vtkIdType i = 0; i < count; ++i)
      triangles.corners.push_back(static_cast<std::uint32_t>(points[i]));
  return std::make_shared<const ClosedSurface>(std::move(triangles));
}

void fillImage(vtkImageData* image) {
  image->SetDimensions(64, 64, 48);
  image->SetSpacing(1.0, 1.3, 1.7);
  image->AllocateScalars(VTK_SHORT, 1);
  auto* voxel = static_cast<short*>(image->GetScalarPointer());
  for (int z = 0; z < 48; ++z)
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        *voxel++ = static_cast<short>(500.0 + 200.0 * std::sin(0.3 * x) * std::cos(0.25 * y) +
                                      100.0 * std::sin(0.4 * z));
}

/// Bilinear interpolation, with the border's depths outside.
double interpolate(const DepthMap& map, double x, double y) {
  const SampleGrid& grid = map.grid;
  const double column = std::clamp((x - grid.x) / grid.pitch, 0.0, grid.columns - 1.0);
  const double row = std::clamp((grid.y - y) / grid.pitch, 0.0, grid.rows - 1.0);
  const int left = std::min(static_cast<int>(column), grid.columns - 2);
  const int top = std::min(static_cast<int>(row), grid.rows - 2);
  const auto at = [&](int i, int j) {
    return static_cast<double>(map.depths[static_cast<std::size_t>(j * grid.columns + i)]);
  };
  const double u = column - left, v = row - top;
  return (1.0 - v) * ((1.0 - u) * at(left, top) + u * at(left + 1, top)) +
         v * ((1.0 - u) * at(left, top + 1) + u * at(left + 1, top + 1));
}

fenestra::core::LiveCamera toLiveCamera(vtkRenderer* renderer) {
  vtkCamera* camera = renderer->GetActiveCamera();
  fenestra::core::LiveCamera live{};
  camera->GetPosition(live.position.data());
  camera->GetFocalPoint(live.target.data());
  camera->GetViewUp(live.up.data());
  live.isPerspective = camera->GetParallelProjection() == 0;
  live.angle = camera->GetViewAngle();
  live.scale = camera->GetParallelScale();
  renderer->GetTiledSize(&live.width, &live.height);
  return live;
}

} // namespace

bool DepthPass::PreReplaceShaderValues(std::string& vertexShader, std::string& geometryShader,
                                       std::string& fragmentShader, vtkAbstractMapper* mapper,
                                       vtkProp* prop) {
  const char* encode = R"GLSL(
  //VTK::Base::Exit
  vec4 test_start = in_modelViewMatrix * in_volumeMatrix[0] * in_textureDatasetMatrix[0] *
                    inverse(in_cellToPoint[0]) * vec4(g_rayOrigin - g_rayJitter, 1.0);
  int test_depth = int(-test_start.z / 1000.0 * 16777216.0);
  g_fragColor = vec4(float(test_depth / 65536), float(test_depth / 256 % 256),
                     float(test_depth % 256), 255.0) / 255.0;
)GLSL";
  vtkShaderProgram::Substitute(fragmentShader, "//VTK::Base::Exit", encode, false);
  return this->Superclass::PreReplaceShaderValues(vertexShader, geometryShader, fragmentShader,
                                                  mapper, prop);
}

Subject::Subject() {
  fillImage(this->image);
  setTransform(this->toWorld, 35.0, {12.0, -20.0, 40.0});
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(300.0, 0.02);
  opacity->AddPoint(800.0, 0.6);
  vtkNew<vtkColorTransferFunction> color;
  color->AddRGBPoint(300.0, 0.3, 0.3, 0.9);
  color->AddRGBPoint(800.0, 1.0, 0.8, 0.5);
  this->property->SetScalarOpacity(opacity);
  this->property->SetColor(color);
  this->property->SetInterpolationTypeToLinear();
  this->property->ShadeOn();
  double bounds[6];
  this->image->GetBounds(bounds);
  for (std::size_t i = 0; i < 8; ++i)
    this->box[i] =
        transform(this->toWorld, bounds[i & 1], bounds[2 + (i >> 1 & 1)], bounds[4 + (i >> 2 & 1)]);
  this->center = transform(this->toWorld, 30.0, 42.0, 38.0);
  this->focus = makeEllipsoid(this->center);
}

View::View(const Subject& subject) {
  this->mapper->SetInputData(subject.image);
  this->mapper->SetAutoAdjustSampleDistances(0);
  this->mapper->SetSampleDistance(1.0F);
  this->mapper->UseJitteringOn();
  this->volume->SetMapper(this->mapper);
  this->volume->SetProperty(subject.property);
  this->volume->SetUserMatrix(subject.toWorld);
  this->renderer->SetBackground(1.0, 1.0, 1.0);
  this->renderer->AddVolume(this->volume);
  this->look(subject, {0.0, -1.0, 0.3}, 300.0, true);
}

void View::look(const Subject& subject, const std::array<double, 3>& direction, double distance,
                bool isPerspective) {
  const double length = std::hypot(direction[0], direction[1], direction[2]);
  vtkCamera* camera = this->renderer->GetActiveCamera();
  camera->SetFocalPoint(subject.center.data());
  camera->SetPosition(subject.center[0] + distance * direction[0] / length,
                      subject.center[1] + distance * direction[1] / length,
                      subject.center[2] + distance * direction[2] / length);
  camera->SetViewUp(0.1, 0.2, 1.0);
  camera->SetViewAngle(22.0);
  camera->SetParallelScale(55.0);
  camera->SetParallelProjection(isPerspective ? 0 : 1);
  camera->SetClippingRange(1.0, 700.0);
}

std::vector<float> toDepths(const Image& image) {
  std::vector<float> depths;
  for (std::size_t i = 0; i < image.colors.size(); i += 3) {
    const int code = 65536 * image.colors[i] + 256 * image.colors[i + 1] + image.colors[i + 2];
    depths.push_back(code == 0xFFFFFF ? infinity : static_cast<float>(code * 1000.0 / 16777216.0));
  }
  return depths;
}

LiveSurface buildSurface(const Subject& subject, vtkRenderer* renderer) {
  return fenestra::core::buildLiveSurface(*subject.focus, subject.box, toLiveCamera(renderer));
}

Differences compareDepths(const LiveSurface& surface, double offset, bool isCutaway, int width,
                          const std::vector<float>& entries, const std::vector<float>& depths) {
  Differences differences;
  const SampleGrid& grid = surface.focus.grid;
  const auto height = static_cast<int>(depths.size()) / width;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (!std::isfinite(depths[i]))
      continue;
    const int column = static_cast<int>(i) % width, row = static_cast<int>(i) / width;
    const double x = (column + 0.5 - 0.5 * width) * grid.pitch;
    const double y = (0.5 * height - row - 0.5) * grid.pitch;
    const auto focusColumn = static_cast<int>(std::lround((x - grid.x) / grid.pitch));
    const auto focusRow = static_cast<int>(std::lround((grid.y - y) / grid.pitch));
    const bool isInside =
        focusColumn >= 0 && focusColumn < grid.columns && focusRow >= 0 && focusRow < grid.rows;
    const float focus =
        isInside
            ? surface.focus.depths[static_cast<std::size_t>(focusRow * grid.columns + focusColumn)]
            : infinity;
    const bool isFocus = std::isfinite(focus);
    const double depth = isFocus ? static_cast<double>(focus) : interpolate(surface.fill, x, y);
    const bool isMoved = (isFocus || !isCutaway) && depth + offset > entries[i];
    const double difference =
        std::abs(depths[i] - (isMoved ? depth + offset : static_cast<double>(entries[i])));
    double& largest = isFocus ? differences.atFocus : differences.beside;
    largest = std::max(largest, difference);
    (isFocus ? differences.focusPixels : differences.besidePixels) += isMoved ? 1 : 0;
  }
  return differences;
}

} // namespace opening
