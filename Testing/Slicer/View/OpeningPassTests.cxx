// The opening of VTK's volume rendering, by images and by the depths at which rays start.

#include "OpeningPassViews.h"

#include <vtkCamera.h>
#include <vtkInformation.h>
#include <vtkInformationObjectBaseVectorKey.h>
#include <vtkLightKit.h>
#include <vtkPlane.h>
#include <vtkShaderProperty.h>
#include <vtkSmartPointer.h>
#include <vtkWeakPointer.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <iostream>
#include <string>

namespace opening {
namespace {

class OpeningPass : public views::ViewTest {
protected:
  Image render(const View& view) { return ViewTest::render(view.renderer); }
  std::vector<float> renderDepths(const View& view) { return toDepths(this->render(view)); }

  /// Compares the depths at which a view's rays start with those of LiveSurface.
  Differences measure(const View& view, vtkFenestraOpeningPass* pass, double offset = 0.0) {
    pass->SetSubject(nullptr, this->subject.box);
    const std::vector<float> entries = this->renderDepths(view);
    pass->SetSubject(this->subject.focus, this->subject.box);
    const Image image = this->render(view);
    return compareDepths(buildSurface(this->subject, view.renderer), offset, this->isCutaway,
                         image.width, entries, toDepths(image));
  }

  const Subject subject;
  bool isCutaway = false;
};

void expectSmall(const Differences& differences) {
  EXPECT_LT(differences.atFocus, 0.01);
  EXPECT_LT(differences.beside, 0.05);
  EXPECT_GT(differences.focusPixels, 500);
}

TEST_F(OpeningPass, RaysStartOnTheSurface) {
  View view(this->subject);
  this->window->AddRenderer(view.renderer);
  const vtkNew<DepthPass> pass;
  pass->Attach(view.renderer, view.volume);
  Differences largest;
  const std::array<double, 3> directions[] = {
      {0.0, -1.0, 0.3}, {1.0, 0.2, -0.4}, {-0.5, 0.8, 0.1}, {0.3, 0.3, 1.0}};
  for (const bool isPerspective : {true, false})
    for (const std::array<double, 3>& direction : directions) {
      view.look(this->subject, direction, 300.0, isPerspective);
      const Differences differences = this->measure(view, pass);
      expectSmall(differences);
      EXPECT_GT(differences.besidePixels, 4000);
      largest.atFocus = std::max(largest.atFocus, differences.atFocus);
      largest.beside = std::max(largest.beside, differences.beside);
    }
  std::cout << "largest differences: " << largest.atFocus << " mm in the focus, " << largest.beside
            << " mm beside\nlast surface: " << pass->GetSeconds() << " s\n";
  pass->Detach();
}

TEST_F(OpeningPass, RaysStartOnTheSurfaceFromInsideTheVolume) {
  View view(this->subject);
  this->window->AddRenderer(view.renderer);
  const vtkNew<DepthPass> pass;
  pass->Attach(view.renderer, view.volume);
  view.look(this->subject, {0.1, 1.0, 0.2}, 24.0, true);
  view.renderer->GetActiveCamera()->SetViewAngle(60.0);
  expectSmall(this->measure(view, pass));
  pass->Detach();
}

TEST_F(OpeningPass, RaysFollowModeAndOffset) {
  View view(this->subject);
  this->window->AddRenderer(view.renderer);
  view.mapper->UseJitteringOff();
  const vtkNew<DepthPass> pass;
  pass->Attach(view.renderer, view.volume);
  for (const double offset : {3.0, -2.0}) {
    pass->SetOffset(offset);
    expectSmall(this->measure(view, pass, offset));
  }
  pass->SetMode(vtkFenestraOpeningPass::Cutaway);
  this->isCutaway = true;
  const Differences differences = this->measure(view, pass, -2.0);
  expectSmall(differences);
  EXPECT_EQ(differences.besidePixels, 0);
  pass->Detach();
}

TEST_F(OpeningPass, RaysStartBehindClippingPlanes) {
  View view(this->subject);
  this->window->AddRenderer(view.renderer);
  const vtkNew<vtkPlane> plane;
  plane->SetOrigin(this->subject.center[0], this->subject.center[1] - 9.0, this->subject.center[2]);
  plane->SetNormal(0.3, 1.0, 0.0);
  view.mapper->AddClippingPlane(plane);
  const vtkNew<DepthPass> pass;
  pass->Attach(view.renderer, view.volume);
  const Differences differences = this->measure(view, pass);
  EXPECT_LT(differences.atFocus, 0.01);
  EXPECT_LT(differences.beside, 0.05);
  EXPECT_GT(differences.focusPixels, 200); // the plane hides the others
  pass->Detach();
}

TEST_F(OpeningPass, UnopenedImagesEqualThoseWithoutPass) {
  View view(this->subject), plain(this->subject);
  this->window->AddRenderer(plain.renderer);
  for (const float distance : {1.0F, 2.0F}) { // pixels between rays
    plain.mapper->SetImageSampleDistance(distance);
    view.mapper->SetImageSampleDistance(distance);
    this->window->RemoveRenderer(view.renderer);
    this->window->AddRenderer(plain.renderer);
    const std::vector<unsigned char> expected = this->render(plain).colors;
    this->window->RemoveRenderer(plain.renderer);
    this->window->AddRenderer(view.renderer);

    const vtkNew<vtkFenestraOpeningPass> pass;
    pass->Attach(view.renderer, view.volume);
    EXPECT_EQ(this->render(view).colors, expected) << "without focus";
    pass->SetSubject(this->subject.focus, this->subject.box);
    EXPECT_NE(this->render(view).colors, expected) << "opened";
    view.renderer->GetActiveCamera()->SetUseOffAxisProjection(1);
    this->render(view);
    view.renderer->GetActiveCamera()->SetUseOffAxisProjection(0);
    pass->SetSubject(nullptr, this->subject.box);
    EXPECT_EQ(this->render(view).colors, expected) << "without focus again";
    pass->SetSubject(this->subject.focus, this->subject.box);
    EXPECT_NE(this->render(view).colors, expected) << "opened again";
    pass->Detach();
    EXPECT_FALSE(view.volume->GetPropertyKeys()->Has(vtkOpenGLRenderPass::RenderPasses()));
    EXPECT_EQ(this->render(view).colors, expected) << "detached";
  }
}

TEST_F(OpeningPass, NothingIsOpenedWhereTheFocusIsOutOfSight) {
  View view(this->subject);
  this->window->AddRenderer(view.renderer);
  vtkCamera* camera = view.renderer->GetActiveCamera();
  const vtkNew<vtkFenestraOpeningPass> pass;
  pass->Attach(view.renderer, view.volume);
  const auto isOpened = [&] {
    pass->SetSubject(nullptr, this->subject.box);
    const std::vector<unsigned char> closed = this->render(view).colors;
    pass->SetSubject(this->subject.focus, this->subject.box);
    return this->render(view).colors != closed;
  };
  EXPECT_TRUE(isOpened());
  double target[3], position[3];
  camera->GetFocalPoint(target);
  camera->GetPosition(position);
  view.look(this->subject, {0.0, -1.0, 0.3}, 15.0, true);
  camera->SetFocalPoint(camera->GetPosition()[0], camera->GetPosition()[1] - 10.0,
                        camera->GetPosition()[2]);
  EXPECT_FALSE(isOpened()) << "behind the camera";
  camera->SetFocalPoint(target);
  camera->SetPosition(position);
  camera->SetViewUp(target[0] - position[0], target[1] - position[1], target[2] - position[2]);
  EXPECT_FALSE(isOpened()) << "camera without direction";
  camera->SetViewUp(0.1, 0.2, 1.0);
  EXPECT_TRUE(isOpened());
  pass->Detach();
}

TEST_F(OpeningPass, TurningRebuildsNoShader) {
  View view(this->subject);
  this->window->AddRenderer(view.renderer);
  vtkCamera* camera = view.renderer->GetActiveCamera();
  const vtkNew<vtkFenestraOpeningPass> pass;
  pass->Attach(view.renderer, view.volume);
  pass->SetSubject(this->subject.focus, this->subject.box);
  this->render(view);
  const int builds = pass->GetBuilds();
  EXPECT_GE(builds, 1);
  EXPECT_EQ(pass->GetUpdates(), 1);
  std::vector<unsigned char> last;
  for (int frame = 0; frame < 10; ++frame) {
    camera->Azimuth(2.0);
    view.renderer->ResetCameraClippingRange();
    std::vector<unsigned char> colors = this->render(view).colors;
    EXPECT_NE(colors, last);
    last = std::move(colors);
  }
  EXPECT_EQ(pass->GetUpdates(), 11);
  this->render(view);
  camera->SetClippingRange(2.0, 900.0);
  this->render(view);
  pass->SetOffset(1.0);
  pass->SetMode(vtkFenestraOpeningPass::Cutaway);
  this->render(view);
  EXPECT_EQ(pass->GetUpdates(), 11);
  EXPECT_EQ(pass->GetBuilds(), builds);

  this->window->SetSize(200, 180);
  this->render(view);
  EXPECT_EQ(pass->GetUpdates(), 12);
  pass->SetSubject(this->subject.focus, this->subject.box);
  this->render(view);
  EXPECT_EQ(pass->GetUpdates(), 13);
  view.volume->VisibilityOff();
  camera->Azimuth(2.0);
  this->render(view);
  EXPECT_EQ(pass->GetUpdates(), 13);
  pass->Detach();
}

TEST_F(OpeningPass, TwoViewsFollowTheirOwnCameras) {
  View views[] = {View(this->subject), View(this->subject)};
  const vtkNew<DepthPass> passes[2];
  const vtkNew<vtkShaderProperty> shader; // shared, as between Slicer's views
  this->window->SetSize(480, 180);
  for (int i = 0; i < 2; ++i) {
    views[i].volume->SetShaderProperty(shader);
    views[i].renderer->SetViewport(0.5 * i, 0.0, 0.5 * i + 0.5, 1.0);
    this->window->AddRenderer(views[i].renderer);
    passes[i]->Attach(views[i].renderer, views[i].volume);
    passes[i]->SetSubject(this->subject.focus, this->subject.box);
  }
  views[1].look(this->subject, {1.0, 0.5, 0.2}, 250.0, false);
  for (int i = 0; i < 2; ++i)
    expectSmall(this->measure(views[i], passes[i]));
  views[0].renderer->GetActiveCamera()->Azimuth(20.0);
  const int updates = passes[1]->GetUpdates();
  for (int i = 0; i < 2; ++i) {
    const Image image = this->render(views[i]);
    const Differences differences =
        compareDepths(buildSurface(this->subject, views[i].renderer), 0.0, false, image.width,
                      std::vector<float>(image.colors.size() / 3, 0.0F), toDepths(image));
    EXPECT_LT(differences.atFocus, 0.01);
  }
  EXPECT_EQ(passes[1]->GetUpdates(), updates);
  for (int i = 0; i < 2; ++i)
    passes[i]->Detach();
}

TEST_F(OpeningPass, LightsCroppingAndCoarseRaysGiveNoErrors) {
  View view(this->subject);
  this->window->AddRenderer(view.renderer);
  const vtkNew<vtkFenestraOpeningPass> pass;
  pass->Attach(view.renderer, view.volume);
  const auto renderBoth = [&] {
    pass->SetSubject(nullptr, this->subject.box);
    const std::vector<unsigned char> closed = this->render(view).colors;
    pass->SetSubject(this->subject.focus, this->subject.box);
    EXPECT_NE(this->render(view).colors, closed);
  };
  const vtkNew<vtkLightKit> kit;
  kit->AddLightsToRenderer(view.renderer);
  renderBoth();
  const vtkNew<vtkPlane> plane;
  plane->SetOrigin(this->subject.center.data());
  plane->SetNormal(1.0, 0.0, 0.0);
  view.mapper->AddClippingPlane(plane);
  renderBoth();
  view.mapper->SetImageSampleDistance(2.0F);
  renderBoth();
  view.mapper->RemoveAllClippingPlanes();
  view.mapper->CroppingOn();
  view.mapper->SetCroppingRegionPlanes(10.0, 50.0, 10.0, 80.0, 5.0, 70.0);
  renderBoth();
  this->subject.property->ShadeOff();
  view.mapper->SetBlendModeToMaximumIntensity();
  renderBoth();
  pass->Detach();
}

TEST_F(OpeningPass, ReferencesEndInAnyOrder) {
  const auto attach = [this](vtkFenestraOpeningPass* pass, View& view) {
    this->window->AddRenderer(view.renderer);
    pass->Attach(view.renderer, view.volume);
    pass->SetSubject(this->subject.focus, this->subject.box);
    this->render(view);
  };
  const vtkNew<vtkFenestraOpeningPass> pass;
  {
    View view(this->subject);
    attach(pass, view);
    EXPECT_EQ(pass->GetVolume(), view.volume.Get());
    pass->Detach();
    this->render(view);
    EXPECT_EQ(pass->GetReferenceCount(), 1) << "detached";
    EXPECT_EQ(pass->GetVolume(), nullptr);

    pass->Attach(view.renderer, view.volume);
    this->render(view);
    view.renderer->RemoveVolume(view.volume);
    this->render(view);
    pass->Detach();
    this->window->RemoveRenderer(view.renderer);
  }
  EXPECT_EQ(pass->GetReferenceCount(), 1) << "volume removed before";
  {
    View view(this->subject);
    attach(pass, view);
    this->window->RemoveRenderer(view.renderer);
  }
  EXPECT_EQ(pass->GetVolume(), nullptr);
  EXPECT_EQ(pass->GetReferenceCount(), 1) << "renderer and volume deleted";
  vtkSmartPointer<vtkVolume> volume;
  {
    View view(this->subject);
    attach(pass, view);
    volume = view.volume;
    this->window->RemoveRenderer(view.renderer);
  }
  EXPECT_EQ(pass->GetVolume(), volume) << "renderer deleted";
  pass->Detach();
  EXPECT_FALSE(volume->GetPropertyKeys()->Has(vtkOpenGLRenderPass::RenderPasses()));
  volume = nullptr;
  EXPECT_EQ(pass->GetReferenceCount(), 1) << "renderer deleted before";

  View view(this->subject);
  vtkWeakPointer<vtkFenestraOpeningPass> owned;
  {
    const vtkNew<vtkFenestraOpeningPass> other;
    attach(other, view);
    owned = other;
  }
  ASSERT_NE(owned, nullptr) << "the volume's";
  owned->Detach();
  this->render(view);
  EXPECT_EQ(owned, nullptr);
}

TEST_F(OpeningPass, WindowsThatWereClosedOpenAgain) {
  View view(this->subject);
  this->window->AddRenderer(view.renderer);
  const vtkNew<vtkFenestraOpeningPass> pass;
  pass->Attach(view.renderer, view.volume);
  pass->SetSubject(this->subject.focus, this->subject.box);
  const std::vector<unsigned char> colors = this->render(view).colors;
  this->window->Finalize();
  EXPECT_EQ(this->render(view).colors, colors);

  this->window->RemoveRenderer(view.renderer);
  const vtkNew<vtkRenderWindow> other;
  views::setUpWindow(other);
  other->AddRenderer(view.renderer);
  EXPECT_EQ(renderImage(other, view.renderer).colors, colors);
  pass->Detach();
}

TEST_F(OpeningPass, TiledImagesShowOneSurface) {
  View view(this->subject);
  this->window->AddRenderer(view.renderer);
  const vtkNew<DepthPass> pass;
  pass->Attach(view.renderer, view.volume);
  pass->SetSubject(this->subject.focus, this->subject.box);
  const vtkNew<vtkWindowToImageFilter> tiles;
  tiles->SetInput(this->window);
  tiles->SetScale(2);
  tiles->ReadFrontBufferOff();
  tiles->Update();
  Image tiled{480, 360, {}};
  for (int row = 359; row >= 0; --row) {
    const auto* first =
        static_cast<unsigned char*>(tiles->GetOutput()->GetScalarPointer(0, row, 0));
    tiled.colors.insert(tiled.colors.end(), first, first + 3 * 480);
  }
  this->window->SetSize(480, 360);
  const std::vector<float> found = toDepths(tiled), expected = this->renderDepths(view);
  ASSERT_EQ(found.size(), expected.size());
  int different = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    different += found[i] == expected[i] || std::abs(found[i] - expected[i]) < 0.05F ? 0 : 1;
  EXPECT_LT(different, 800); // pixels at edges
  pass->Detach();
}

} // namespace
} // namespace opening
