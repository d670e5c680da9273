// Images with depth beside volumes, and their lifetime.

#include "ImagePropViews.h"
#include "OpeningPassViews.h"

#include <vtkCamera.h>
#include <vtkCellPicker.h>
#include <vtkMath.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkSmartPointer.h>
#include <vtkTextureUnitManager.h>

#include <algorithm>
#include <cmath>

namespace image {
namespace {

/// The left half at a depth in mm, and nothing in the right half.
std::shared_ptr<FenestraViewImage> makeHalf(int width, int height, float depth) {
  auto image = std::make_shared<FenestraViewImage>();
  image->width = width;
  image->height = height;
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const bool isLeft = 2 * column < width;
      for (const int value : {7 * row, 3 * column, 200, isLeft ? 255 : 0})
        image->rgba.push_back(static_cast<unsigned char>(value % 256));
      image->depth.push_back(isLeft ? depth : FenestraViewImage::noDepth);
    }
  return image;
}

/// Differences of colors in one half.
int countDifferent(const Image& a, const Image& b, bool isLeft) {
  int different = 0;
  for (std::size_t i = 0; i < a.colors.size(); ++i) {
    const int column = static_cast<int>(i / 3) % a.width;
    different += (2 * column < a.width) == isLeft && a.colors[i] != b.colors[i] ? 1 : 0;
  }
  return different;
}

TEST_F(ImageProp, VolumesAndTheirOpeningsStayAsTheyAre) {
  const opening::Subject subject;
  opening::View view(subject);
  this->window->AddRenderer(view.renderer);
  const vtkNew<vtkFenestraOpeningPass> pass;
  pass->Attach(view.renderer, view.volume);
  pass->SetSubject(subject.focus, subject.box);
  const Image opened = this->render(view.renderer);
  const int updates = pass->GetUpdates(), builds = pass->GetBuilds();

  const vtkNew<vtkFenestraImageProp> prop;
  prop->SetRenderer(view.renderer);
  const auto front = makeHalf(240, 180, 5.0F);
  prop->SetImage(front);
  const Image covered = this->render(view.renderer);
  EXPECT_EQ(countDifferent(covered, opened, false), 0) << "beside the image";
  Image expected = opened;
  for (std::size_t i = 0; i < expected.colors.size() / 3; ++i)
    if (2 * (i % 240) < 240)
      std::copy_n(&front->rgba[4 * i], 3, &expected.colors[3 * i]);
  EXPECT_EQ(countDifferent(covered, expected, true), 0) << "before the volume";

  prop->SetImage(makeHalf(240, 180, 300.0F));
  const Image crossed = this->render(view.renderer);
  EXPECT_EQ(countDifferent(crossed, opened, false), 0);
  EXPECT_GT(countDifferent(crossed, opened, true), 1000) << "in the volume";
  EXPECT_GT(countDifferent(crossed, covered, true), 1000) << "in the volume";

  prop->SetRenderer(nullptr);
  EXPECT_EQ(this->render(view.renderer).colors, opened.colors);
  EXPECT_EQ(pass->GetUpdates(), updates);
  EXPECT_EQ(pass->GetBuilds(), builds);
  pass->Detach();
}

TEST_F(ImageProp, RemovalLeavesTheFrameAsBefore) {
  for (const bool isPeeled : {false, true}) {
    View view(this->window);
    view.renderer->SetUseDepthPeeling(isPeeled);
    const Model half({35.0, -20.0, 10.0}, 20.0), translucent({-10.0, -40.0, -10.0}, 15.0, 0.5);
    view.renderer->AddActor(half.actor);
    view.renderer->AddActor(translucent.actor);
    const std::vector<unsigned char> before = this->render(view.renderer).colors;
    this->show(view, Alpha::Soft);
    EXPECT_NE(this->render(view.renderer).colors, before);
    view.prop->SetImage(nullptr);
    EXPECT_EQ(this->render(view.renderer).colors, before);
    this->show(view, Alpha::Soft);
    EXPECT_NE(this->render(view.renderer).colors, before);
    vtkTextureUnitManager* units =
        vtkOpenGLRenderWindow::SafeDownCast(this->window)->GetState()->GetTextureUnitManager();
    for (int unit = 0; unit < units->GetNumberOfTextureUnits(); ++unit)
      EXPECT_FALSE(units->IsAllocated(unit)) << "texture unit " << unit;
    view.prop->SetRenderer(nullptr);
    EXPECT_EQ(view.prop->GetRenderer(), nullptr);
    EXPECT_EQ(this->render(view.renderer).colors, before);
    EXPECT_EQ(view.prop->GetReferenceCount(), 1);
    this->window->RemoveRenderer(view.renderer);
  }
}

TEST_F(ImageProp, ReferencesEndInAnyOrder) {
  const vtkNew<vtkFenestraImageProp> prop;
  vtkSmartPointer<vtkRenderer> kept;
  {
    View view(this->window);
    prop->SetRenderer(view.renderer);
    prop->SetImage(makeHalf(240, 180, 300.0F));
    this->render(view.renderer);
    EXPECT_TRUE(prop->GetVisibility());
    this->window->RemoveRenderer(view.renderer);
  }
  EXPECT_EQ(prop->GetRenderer(), nullptr) << "renderer deleted";
  EXPECT_EQ(prop->GetReferenceCount(), 1);
  EXPECT_FALSE(prop->GetVisibility());
  EXPECT_EQ(prop->GetBounds(), nullptr);
  EXPECT_FALSE(prop->FindPoint(10.0, 90.0));
  prop->SetImage(makeHalf(240, 180, 300.0F));
  {
    View view(this->window);
    prop->SetRenderer(view.renderer);
    EXPECT_FALSE(prop->GetVisibility()) << "image of another renderer";
    this->show(view, Alpha::Soft);
    this->render(view.renderer);
    kept = view.renderer;
    prop->SetRenderer(nullptr);
  }
  this->render(kept); // the prop of the view is the renderer's
  EXPECT_EQ(kept->GetActors()->GetNumberOfItems(), 1);
  this->window->RemoveRenderer(kept);

  View view(this->window);
  this->show(view, Alpha::Soft);
  this->render(view.renderer);
  this->window->RemoveRenderer(view.renderer);
  EXPECT_FALSE(view.prop->GetVisibility()) << "renderer without a window";
  view.prop->SetRenderer(nullptr);
}

TEST_F(ImageProp, PickersFindNothingWhereDepthsJump) {
  View view(this->window);
  this->render(view.renderer);
  const auto traced = makeHalf(240, 180, 250.0F);
  for (float& depth : traced->depth)
    depth = depth > 250.0F ? 350.0F : depth;
  view.prop->SetImage(traced);
  this->render(view.renderer);
  const vtkNew<vtkCellPicker> picker;
  double axis[3], position[3];
  view.renderer->GetActiveCamera()->GetDirectionOfProjection(axis);
  view.renderer->GetActiveCamera()->GetPosition(position);
  int found = 0, gaps = 0;
  for (int x = 100; x < 140; ++x) {
    if (!picker->Pick(x, 90.0, 0.0, view.renderer)) {
      ++gaps;
      continue;
    }
    ++found;
    double point[3];
    picker->GetPickPosition(point);
    vtkMath::Subtract(point, position, point);
    const double depth = vtkMath::Dot(point, axis);
    EXPECT_LT(std::min(std::abs(depth - 250.0), std::abs(depth - 350.0)), 0.01) << x;
  }
  EXPECT_GT(found, 30);
  EXPECT_GT(gaps, 0);
}

TEST_F(ImageProp, WindowsThatWereClosedShowTheImageAgain) {
  View view(this->window);
  this->show(view, Alpha::Soft);
  const std::vector<unsigned char> shown = this->render(view.renderer).colors;
  this->window->Finalize();
  EXPECT_EQ(this->render(view.renderer).colors, shown);

  this->window->RemoveRenderer(view.renderer);
  const vtkNew<vtkRenderWindow> other;
  views::setUpWindow(other);
  other->AddRenderer(view.renderer);
  EXPECT_EQ(views::renderImage(other, view.renderer).colors, shown);
}

TEST_F(ImageProp, LateImagesAreShownOnlyToTheirCamera) {
  View view(this->window);
  this->render(view.renderer);
  const auto camera = FenestraViewCamera::FromRenderer(view.renderer);
  ASSERT_TRUE(camera);
  const auto traced = trace(view.renderer, 240, 180, Alpha::Soft);
  view.look({250.0, 100.0, 20.0}, false);
  const std::vector<unsigned char> moved = this->render(view.renderer).colors;
  view.prop->SetImage(traced, *camera);
  EXPECT_EQ(this->render(view.renderer).colors, moved);
  view.look({20.0, -300.0, 60.0}, false);
  EXPECT_EQ(image::countDifferent(this->render(view.renderer),
                                  compose(enlarge(*traced, 240, 180), background), rounding),
            0);
}

TEST_F(ImageProp, ImagesOfOtherSizesThanTheirArraysAreRefused) {
  View view(this->window);
  this->render(view.renderer);
  const auto traced = trace(view.renderer, 240, 180, Alpha::Soft);
  traced->depth.pop_back();
  view.prop->SetImage(traced);
  EXPECT_FALSE(view.prop->GetVisibility());
  EXPECT_EQ(this->messages->Count, 1);
  this->messages->Count = 0;
}

} // namespace
} // namespace image
