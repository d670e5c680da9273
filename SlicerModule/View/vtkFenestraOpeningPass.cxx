#include "vtkFenestraOpeningPass.h"

#include "FenestraOpeningShader.h"

#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkInformation.h>
#include <vtkInformationObjectBaseVectorKey.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkShaderProgram.h>
#include <vtkTextureObject.h>
#include <vtkVolume.h>

#include <chrono>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

vtkStandardNewMacro(vtkFenestraOpeningPass);

namespace {
using fenestra::core::DepthMap;
using fenestra::core::LiveCamera;

/// For samplers that are not used. VTK takes units from 0 upward, and one of a 3D texture would be
/// an error of OpenGL, which has at least 48 units.
constexpr int unusedTextureUnit = 47;

auto ToTuple(const LiveCamera& camera) {
  return std::tie(camera.position, camera.target, camera.up, camera.isPerspective, camera.angle,
                  camera.scale, camera.width, camera.height);
}

/// Nothing for cameras that LiveCamera cannot describe.
std::optional<LiveCamera> MakeCamera(vtkRenderer* renderer) {
  constexpr double degree = 3.14159265358979323846 / 180.0;
  vtkCamera* camera = renderer->GetActiveCamera();
  if (camera->GetUseOffAxisProjection() || camera->GetUseHorizontalViewAngle() ||
      camera->GetUserTransform() || camera->GetUserViewTransform())
    return std::nullopt;
  LiveCamera live{};
  camera->GetPosition(live.position.data());
  camera->GetFocalPoint(live.target.data());
  camera->GetViewUp(live.up.data());
  live.isPerspective = camera->GetParallelProjection() == 0;
  renderer->GetTiledSize(&live.width, &live.height);
  // The part of a larger view that VTK renders as one tile of an image: the surface is the larger
  // view's.
  const double* center = camera->GetWindowCenter();
  const double height = live.height;
  live.width = static_cast<int>(std::ceil((1.0 + std::abs(center[0])) * live.width));
  live.height = static_cast<int>(std::ceil((1.0 + std::abs(center[1])) * live.height));
  const double zoom = live.height / height;
  live.angle = 2.0 * std::atan(zoom * std::tan(0.5 * degree * camera->GetViewAngle())) / degree;
  live.scale = zoom * camera->GetParallelScale();
  return live;
}

} // namespace

void vtkFenestraOpeningPass::DeviceMap::Upload(DepthMap map, int filter,
                                               vtkOpenGLRenderWindow* window) {
  if (map.depths.empty())
    map = {{0.0, 0.0, 1.0, 1, 1}, {FenestraOpening::notFocus}};
  for (float& depth : map.depths)
    if (!std::isfinite(depth))
      depth = FenestraOpening::notFocus;
  if (!this->Texture)
    this->Texture = vtkSmartPointer<vtkTextureObject>::New();
  this->Texture->SetContext(window);
  this->Texture->SetMinificationFilter(filter);
  this->Texture->SetMagnificationFilter(filter);
  this->Texture->SetWrapS(vtkTextureObject::ClampToEdge);
  this->Texture->SetWrapT(vtkTextureObject::ClampToEdge);
  const auto& grid = map.grid;
  this->Texture->Create2DFromRaw(static_cast<unsigned int>(grid.columns),
                                 static_cast<unsigned int>(grid.rows), 1, VTK_FLOAT,
                                 map.depths.data());
  this->Window[0] = static_cast<float>(grid.x - 0.5 * grid.pitch);
  this->Window[1] = static_cast<float>(grid.y + 0.5 * grid.pitch);
  this->Window[2] = static_cast<float>(1.0 / (grid.pitch * grid.columns));
  this->Window[3] = static_cast<float>(-1.0 / (grid.pitch * grid.rows));
}

bool vtkFenestraOpeningPass::DeviceMap::IsIn(vtkOpenGLRenderWindow* window) {
  return this->Texture && this->Texture->GetContext() == window && this->Texture->GetHandle() != 0;
}

vtkFenestraOpeningPass::vtkFenestraOpeningPass() {
  this->ActiveDrawBuffers = 1; // the mapper asks for them when it renders at a reduced size
}

vtkFenestraOpeningPass::~vtkFenestraOpeningPass() {
  this->Detach();
}

void vtkFenestraOpeningPass::Attach(vtkRenderer* renderer, vtkVolume* volume) {
  this->Detach();
  if (!volume->GetPropertyKeys()) {
    vtkNew<vtkInformation> keys;
    volume->SetPropertyKeys(keys);
  }
  volume->GetPropertyKeys()->Append(vtkOpenGLRenderPass::RenderPasses(), this);
  this->StartObserver =
      renderer->AddObserver(vtkCommand::StartEvent, this, &vtkFenestraOpeningPass::OnStart);
  this->EndObserver =
      renderer->AddObserver(vtkCommand::EndEvent, this, &vtkFenestraOpeningPass::OnEnd);
  // Appending keeps two references, of which the deletion of the keys drops only one.
  this->DeleteObserver =
      volume->AddObserver(vtkCommand::DeleteEvent, this, &vtkFenestraOpeningPass::Detach);
  this->Renderer = renderer;
  this->Volume = volume;
}

void vtkFenestraOpeningPass::Detach() {
  this->OnEnd();
  if (this->Renderer) {
    this->Renderer->RemoveObserver(this->StartObserver);
    this->Renderer->RemoveObserver(this->EndObserver);
  }
  this->Renderer = nullptr;
  this->FocusMap = {};
  this->FillMap = {};
  this->Camera.reset();
  if (!this->Volume)
    return;
  this->Volume->RemoveObserver(this->DeleteObserver);
  vtkInformation* keys = this->Volume->GetPropertyKeys();
  this->Volume = nullptr;
  if (!keys)
    return;
  keys->Remove(vtkOpenGLRenderPass::RenderPasses(), this); // may delete this
  // The mapper looks at the last pass wherever there is a key.
  if (keys->Length(vtkOpenGLRenderPass::RenderPasses()) == 0)
    keys->Remove(vtkOpenGLRenderPass::RenderPasses());
}

vtkVolume* vtkFenestraOpeningPass::GetVolume() {
  return this->Volume;
}

void vtkFenestraOpeningPass::SetSubject(std::shared_ptr<const fenestra::core::ClosedSurface> focus,
                                        const fenestra::core::BoxCorners& volume) {
  this->Focus = std::move(focus);
  this->Box = volume;
  this->Camera.reset();
}

void vtkFenestraOpeningPass::SetMode(int mode) {
  this->Mode = mode;
}

void vtkFenestraOpeningPass::SetOffset(double mm) {
  this->Offset = mm;
}

void vtkFenestraOpeningPass::Render(const vtkRenderState* /*state*/) {}

bool vtkFenestraOpeningPass::PreReplaceShaderValues(std::string& /*vertexShader*/,
                                                    std::string& /*geometryShader*/,
                                                    std::string& fragmentShader,
                                                    vtkAbstractMapper* /*mapper*/,
                                                    vtkProp* /*prop*/) {
  ++this->Builds;
  return FenestraOpening::InsertBeforeReplacement(fragmentShader);
}

bool vtkFenestraOpeningPass::PostReplaceShaderValues(std::string& /*vertexShader*/,
                                                     std::string& /*geometryShader*/,
                                                     std::string& fragmentShader,
                                                     vtkAbstractMapper* /*mapper*/,
                                                     vtkProp* /*prop*/) {
  FenestraOpening::InsertAfterReplacement(fragmentShader);
  return true;
}

vtkMTimeType vtkFenestraOpeningPass::GetShaderStageMTime() {
  return 1;
}

bool vtkFenestraOpeningPass::SetShaderParameters(vtkShaderProgram* program,
                                                 vtkAbstractMapper* /*mapper*/, vtkProp* /*prop*/,
                                                 vtkOpenGLVertexArrayObject* /*array*/) {
  const int opened = this->Mode == Cutaway ? FenestraOpening::Cutaway : FenestraOpening::Surface;
  const auto getUnit = [this](const DeviceMap& map) {
    return this->IsOpen ? map.Texture->GetTextureUnit() : unusedTextureUnit;
  };
  program->SetUniformi("fenestra_mode", this->IsOpen ? opened : FenestraOpening::Off);
  program->SetUniformi("fenestra_focus", getUnit(this->FocusMap));
  program->SetUniformi("fenestra_fill", getUnit(this->FillMap));
  program->SetUniform4f("fenestra_focusWindow", this->FocusMap.Window);
  program->SetUniform4f("fenestra_fillWindow", this->FillMap.Window);
  program->SetUniformf("fenestra_targetDepth", static_cast<float>(this->TargetDepth));
  program->SetUniformf("fenestra_offset", static_cast<float>(this->Offset));
  return true;
}

void vtkFenestraOpeningPass::OnStart() {
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(this->Renderer->GetRenderWindow());
  const std::optional<LiveCamera> camera = MakeCamera(this->Renderer);
  if (!window || !camera || !this->Focus || !this->Volume || !this->Volume->GetVisibility())
    return;
  const bool isSame = this->Camera && ToTuple(*this->Camera) == ToTuple(*camera);
  // A window that was closed has released its textures.
  const bool isKept =
      !this->HasSurface || (this->FocusMap.IsIn(window) && this->FillMap.IsIn(window));
  if (!isSame || !isKept) {
    this->Camera = camera;
    this->HasSurface = this->Update(*camera, window);
  }
  if (!this->HasSurface)
    return;
  this->FocusMap.Texture->Activate();
  this->FillMap.Texture->Activate();
  this->IsOpen = true;
}

void vtkFenestraOpeningPass::OnEnd() {
  if (!this->IsOpen)
    return;
  this->IsOpen = false;
  this->FocusMap.Texture->Deactivate();
  this->FillMap.Texture->Deactivate();
}

bool vtkFenestraOpeningPass::Update(const LiveCamera& camera, vtkOpenGLRenderWindow* window) {
  ++this->Updates;
  const auto start = std::chrono::steady_clock::now();
  fenestra::core::LiveSurface surface;
  try {
    surface = fenestra::core::buildLiveSurface(*this->Focus, this->Box, camera);
  } catch (const std::invalid_argument&) { // no direction, no size
  }
  const bool hasSurface = !surface.fill.depths.empty();
  if (hasSurface) {
    this->TargetDepth = camera.isPerspective ? surface.view.targetDepth : 0.0;
    this->FocusMap.Upload(std::move(surface.focus), vtkTextureObject::Nearest, window);
    this->FillMap.Upload(std::move(surface.fill), vtkTextureObject::Linear, window);
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  this->Seconds = elapsed.count();
  return hasSurface;
}
