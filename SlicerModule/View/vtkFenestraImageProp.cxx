#include "vtkFenestraImageProp.h"

#include "FenestraHeightField.h"
#include "FenestraImageShader.h"

#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCommand.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkShaderProgram.h>
#include <vtkShaderProperty.h>
#include <vtkTextureObject.h>

#include <algorithm>
#include <cmath>
#include <utility>

vtkStandardNewMacro(vtkFenestraImageProp);

namespace {

/// A triangle that covers the view, without an edge in it.
vtkSmartPointer<vtkPolyData> MakeTriangle() {
  const vtkNew<vtkPoints> points;
  points->InsertNextPoint(-1.0, -1.0, 0.0);
  points->InsertNextPoint(3.0, -1.0, 0.0);
  points->InsertNextPoint(-1.0, 3.0, 0.0);
  const vtkNew<vtkCellArray> cells;
  cells->InsertNextCell({0, 1, 2});
  auto triangle = vtkSmartPointer<vtkPolyData>::New();
  triangle->SetPoints(points);
  triangle->SetPolys(cells);
  return triangle;
}

vtkSmartPointer<vtkTextureObject> MakeTexture(vtkOpenGLRenderWindow* window) {
  auto texture = vtkSmartPointer<vtkTextureObject>::New();
  texture->SetContext(window);
  texture->SetMinificationFilter(vtkTextureObject::Nearest);
  texture->SetMagnificationFilter(vtkTextureObject::Nearest);
  texture->SetWrapS(vtkTextureObject::ClampToEdge);
  texture->SetWrapT(vtkTextureObject::ClampToEdge);
  return texture;
}

} // namespace

vtkFenestraImageProp::vtkFenestraImageProp() {
  const vtkSmartPointer<vtkPolyData> triangle = MakeTriangle();
  for (vtkPolyDataMapper* mapper : {this->OpaqueMapper.Get(), this->TranslucentMapper.Get()}) {
    mapper->SetInputData(triangle);
    mapper->AddObserver(vtkCommand::UpdateShaderEvent, this, &vtkFenestraImageProp::SetUniforms);
  }
  this->HeightFieldMapper->SetInputData(vtkNew<vtkPolyData>());
  this->SetMapper(this->HeightFieldMapper);
  this->GetProperty()->LightingOff();
  FenestraImageShader::AddReplacements(this->GetShaderProperty());
}

vtkFenestraImageProp::~vtkFenestraImageProp() = default;

void vtkFenestraImageProp::SetRenderer(vtkRenderer* renderer) {
  if (renderer == this->Renderer)
    return;
  const vtkSmartPointer<vtkFenestraImageProp> self =
      this; // the renderer's reference may be the last
  this->SetImage(nullptr);
  if (this->Renderer)
    this->Renderer->RemoveActor(this);
  this->Renderer = renderer;
  if (renderer)
    renderer->AddActor(this);
}

vtkRenderer* vtkFenestraImageProp::GetRenderer() {
  return this->Renderer;
}

void vtkFenestraImageProp::SetImage(std::shared_ptr<const FenestraViewImage> image) {
  const std::optional<FenestraViewCamera> camera = FenestraViewCamera::FromRenderer(this->Renderer);
  this->SetImage(camera ? std::move(image) : nullptr, camera.value_or(FenestraViewCamera{}));
}

void vtkFenestraImageProp::SetImage(std::shared_ptr<const FenestraViewImage> image,
                                    const FenestraViewCamera& camera) {
  this->Camera.reset();
  this->Image = nullptr;
  this->IsUploaded = false;
  this->HasBounds = false;
  this->HeightFieldMapper->SetInputData(vtkNew<vtkPolyData>());
  this->Modified();
  if (!image)
    return;
  if (!image->IsValid()) {
    vtkErrorMacro("The arrays of the image do not fit its size.");
    return;
  }
  this->Image = std::move(image);
  this->Camera = camera;
  this->HasOpaquePixels = this->HasTranslucentPixels = false;
  for (std::size_t i = 3; i < this->Image->rgba.size(); i += 4) {
    const unsigned char alpha = this->Image->rgba[i];
    this->HasOpaquePixels |= alpha == 255;
    this->HasTranslucentPixels |= alpha > 0 && alpha < 255;
  }
  this->HeightFieldMapper->SetInputData(FenestraHeightField::Build(*this->Image, camera));
  const vtkBoundingBox bounds = FenestraHeightField::ComputeBounds(*this->Image, camera);
  this->HasBounds = bounds.IsValid() != 0;
  if (this->HasBounds)
    bounds.GetBounds(this->ImageBounds.data());
}

void vtkFenestraImageProp::SetOpacity(double opacity) {
  this->Opacity = std::clamp(opacity, 0.0, 1.0);
}

std::optional<FenestraViewCamera::Point> vtkFenestraImageProp::FindPoint(double x, double y) {
  if (!this->GetVisibility())
    return std::nullopt;
  int width = 0, height = 0, left = 0, bottom = 0;
  this->Renderer->GetTiledSizeAndOrigin(&width, &height, &left, &bottom);
  const double viewX = (std::floor(x) + 0.5 - left) / width;
  const double viewY = 1.0 - (std::floor(y) + 0.5 - bottom) / height;
  if (viewX < 0.0 || viewX >= 1.0 || viewY < 0.0 || viewY >= 1.0)
    return std::nullopt;
  const auto column = static_cast<int>(viewX * this->Image->width);
  const auto row = static_cast<int>(viewY * this->Image->height);
  const double depth = static_cast<double>(this->Image->depth[this->Image->GetIndex(column, row)]);
  if (!std::isfinite(depth))
    return std::nullopt;
  return FenestraViewRays(*this->Camera).ToWorld(viewX, viewY, depth);
}

vtkTypeBool vtkFenestraImageProp::GetVisibility() {
  if (!this->Superclass::GetVisibility() || !this->Image || this->Opacity <= 0.0)
    return 0;
  const std::optional<FenestraViewCamera> camera = FenestraViewCamera::FromRenderer(this->Renderer);
  return camera && camera->IsSame(*this->Camera) ? 1 : 0;
}

vtkTypeBool vtkFenestraImageProp::HasOpaqueGeometry() {
  return this->Image && this->HasOpaquePixels && this->Opacity >= 1.0 ? 1 : 0;
}

vtkTypeBool vtkFenestraImageProp::HasTranslucentPolygonalGeometry() {
  return this->Image && (this->HasTranslucentPixels ||
                         (this->HasOpaquePixels && (this->Opacity < 1.0 || this->IsResized())))
             ? 1
             : 0;
}

double* vtkFenestraImageProp::GetBounds() {
  return this->HasBounds && this->GetVisibility() ? this->ImageBounds.data() : nullptr;
}

void vtkFenestraImageProp::Render(vtkRenderer* renderer, vtkMapper* /*mapper*/) {
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
  if (renderer != this->Renderer || !window || !this->Image)
    return;
  this->Upload(window);
  this->ColorTexture->Activate();
  this->DepthTexture->Activate();
  this->Superclass::Render(renderer, this->IsRenderingTranslucentPolygonalGeometry()
                                         ? this->TranslucentMapper.Get()
                                         : this->OpaqueMapper.Get());
  this->ColorTexture->Deactivate();
  this->DepthTexture->Deactivate();
}

void vtkFenestraImageProp::ReleaseGraphicsResources(vtkWindow* window) {
  this->OpaqueMapper->ReleaseGraphicsResources(window);
  this->TranslucentMapper->ReleaseGraphicsResources(window);
  this->ColorTexture = this->DepthTexture = nullptr;
  this->IsUploaded = false;
  this->Superclass::ReleaseGraphicsResources(window);
}

void vtkFenestraImageProp::Upload(vtkOpenGLRenderWindow* window) {
  if (this->IsUploaded) // a window that is closed or left releases the textures
    return;
  const FenestraViewImage& image = *this->Image;
  const auto width = static_cast<unsigned int>(image.width);
  const auto height = static_cast<unsigned int>(image.height);
  std::vector<unsigned char> colors = image.rgba;
  this->ColorTexture = MakeTexture(window);
  this->ColorTexture->Create2DFromRaw(width, height, 4, VTK_UNSIGNED_CHAR, colors.data());
  std::vector<float> depths = image.depth;
  for (float& depth : depths)
    if (!std::isfinite(depth))
      depth = FenestraImageShader::noDepth;
  this->DepthTexture = MakeTexture(window);
  this->DepthTexture->Create2DFromRaw(width, height, 1, VTK_FLOAT, depths.data());
  this->IsUploaded = true;
}

bool vtkFenestraImageProp::IsResized() {
  return this->Image->width != this->Camera->width || this->Image->height != this->Camera->height;
}

void vtkFenestraImageProp::SetUniforms(vtkObject* mapper, unsigned long /*event*/, void* data) {
  auto* program = static_cast<vtkShaderProgram*>(data);
  if (!program || !this->ColorTexture || !this->Renderer)
    return;
  int fragments = mapper == this->OpaqueMapper.Get() ? FenestraImageShader::Opaque
                                                     : FenestraImageShader::Translucent;
  if (this->Renderer->GetSelector())
    fragments = FenestraImageShader::All;
  double nearest = 0.0, farthest = 0.0;
  this->Renderer->GetActiveCamera()->GetClippingRange(nearest, farthest);
  const double range = farthest - nearest;
  const float parallel[] = {static_cast<float>(-nearest / range), static_cast<float>(1.0 / range)};
  const float perspective[] = {static_cast<float>(farthest / range),
                               static_cast<float>(-farthest * nearest / range)};
  program->SetUniformi("fenestra_color", this->ColorTexture->GetTextureUnit());
  program->SetUniformi("fenestra_depth", this->DepthTexture->GetTextureUnit());
  program->SetUniformi("fenestra_isResized", this->IsResized() ? 1 : 0);
  program->SetUniformi("fenestra_fragments", fragments);
  program->SetUniformf("fenestra_opacity", static_cast<float>(this->Opacity));
  program->SetUniformi("fenestra_isParallel", this->Camera->isParallel ? 1 : 0);
  program->SetUniform2f("fenestra_depthTerms", this->Camera->isParallel ? parallel : perspective);
}
