// Images with depth in views, pixel by pixel against arithmetic.

#include "ImagePropViews.h"

#include <vtkCamera.h>
#include <vtkCellPicker.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPropPicker.h>
#include <vtkProperty.h>
#include <vtkWindowToImageFilter.h>
#include <vtkWorldPointPicker.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <iterator>
#include <limits>

namespace image {
namespace {

/// Largest difference of depths, mm, over pixels where both have one. Fails where one has none.
double compareDepths(const std::vector<double>& found, const std::vector<double>& expected) {
  double largest = 0.0;
  int pixels = 0, different = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    different += std::isfinite(found[i]) == std::isfinite(expected[i]) ? 0 : 1;
    if (!std::isfinite(found[i]) || !std::isfinite(expected[i]))
      continue;
    largest = std::max(largest, std::abs(found[i] - expected[i]));
    ++pixels;
  }
  EXPECT_EQ(different, 0);
  EXPECT_GT(pixels, 1000);
  return largest;
}

TEST_F(ImageProp, OpaquePixelsAppearUnchangedAtTheirDepth) {
  View view(this->window);
  for (const bool isParallel : {false, true})
    for (const int samples : {0, 4}) {
      this->window->SetMultiSamples(samples);
      view.look({20.0, -300.0, 60.0}, isParallel);
      const Layer layer = this->show(view, Alpha::Hard);
      EXPECT_EQ(countDifferent(this->render(view.renderer), compose(layer, background), 0.0), 0);
      EXPECT_LT(compareDepths(readDepths(this->window, view.renderer), layer.depths), 0.01);
    }
}

TEST_F(ImageProp, OpaqueModelsAreComposedByDepth) {
  View view(this->window);
  const Model half({35.0, -20.0, 10.0}, 20.0), before({-10.0, -60.0, -10.0}, 8.0);
  view.renderer->AddActor(half.actor);
  view.renderer->AddActor(before.actor);
  for (const bool isParallel : {false, true})
    for (const bool isPeeled : {false, true})
      for (const int samples : {0, 4}) {
        if (isPeeled && samples > 0) // VTK draws nothing translucent then
          continue;
        this->window->SetMultiSamples(samples);
        view.renderer->SetUseDepthPeeling(isPeeled);
        view.look({20.0, -300.0, 60.0}, isParallel);
        const Layer layer = this->show(view, Alpha::Soft);
        const auto [model, depths] = this->renderModel(view);
        std::vector<Rgba> expected;
        int inFront = 0, behind = 0;
        for (std::size_t i = 0; i < depths.size(); ++i) {
          const bool isInFront = depths[i] < layer.depths[i];
          const Rgba color = getColor(model, i);
          expected.push_back(isInFront ? color : blend(layer.colors[i], color));
          inFront += isInFront ? 1 : 0;
          behind += !isInFront && std::isfinite(depths[i]) ? 1 : 0;
        }
        EXPECT_GT(inFront, 1000);
        EXPECT_GT(behind, 200);
        // With multisampling, pixels on the edges of models are mixtures.
        EXPECT_LE(countDifferent(this->render(view.renderer), expected, rounding),
                  samples ? 100 : 4);
      }
}

TEST_F(ImageProp, TranslucentPixelsAreBlended) {
  View view(this->window);
  for (const bool isParallel : {false, true})
    for (const bool isPeeled : {false, true})
      for (const double opacity : {1.0, 0.6, 0.0}) {
        view.renderer->SetUseDepthPeeling(isPeeled);
        view.look({20.0, -300.0, 60.0}, isParallel);
        view.prop->SetOpacity(opacity);
        const Layer layer = this->show(view, Alpha::Soft);
        const Image frame = this->render(view.renderer);
        EXPECT_EQ(countDifferent(frame, compose(layer, background, opacity), rounding), 0);
      }
}

TEST_F(ImageProp, TranslucentModelsAreComposedByDepthPeeling) {
  View view(this->window);
  view.renderer->SetUseDepthPeeling(1);
  const Model model({35.0, -20.0, 10.0}, 20.0, 0.4);
  view.renderer->AddActor(model.actor);
  for (const bool isParallel : {false, true})
    for (const double opacity : {1.0, 0.5}) {
      view.look({20.0, -300.0, 60.0}, isParallel);
      view.prop->SetOpacity(opacity);
      const Layer layer = this->show(view, Alpha::Soft);
      model.actor->GetProperty()->SetOpacity(1.0);
      const auto [frame, depths] = this->renderModel(view);
      model.actor->GetProperty()->SetOpacity(0.4);
      std::vector<Rgba> expected;
      int inFront = 0;
      for (std::size_t i = 0; i < depths.size(); ++i) {
        Rgba color = layer.colors[i], sphere = getColor(frame, i);
        color[3] *= opacity;
        sphere[3] = std::isfinite(depths[i]) ? 0.4 * 255.0 : 0.0;
        const bool isInFront = depths[i] < layer.depths[i];
        expected.push_back(isInFront ? blend(sphere, blend(color, background))
                                     : blend(color, blend(sphere, background)));
        inFront += isInFront ? 1 : 0;
      }
      EXPECT_GT(inFront, 1000);
      EXPECT_LE(countDifferent(this->render(view.renderer), expected, rounding), 4);
    }
}

TEST_F(ImageProp, PixelsWithoutDepthAreBehindAllModels) {
  View view(this->window);
  const Model model({35.0, 20.0, 10.0}, 30.0);
  view.renderer->AddActor(model.actor);
  for (const bool isParallel : {false, true})
    for (const bool isPeeled : {false, true}) {
      view.renderer->SetUseDepthPeeling(isPeeled);
      view.look({20.0, -300.0, 60.0}, isParallel);
      this->render(view.renderer);
      const auto traced = trace(view.renderer, 240, 180, Alpha::Hard);
      for (std::size_t i = 0; i < traced->depth.size(); ++i) {
        traced->depth[i] = FenestraViewImage::noDepth;
        traced->rgba[4 * i + 3] = i % 2 ? 255 : 128;
      }
      view.prop->SetImage(traced);
      const auto [frame, depths] = this->renderModel(view);
      std::vector<Rgba> expected = compose(enlarge(*traced, 240, 180), background);
      for (std::size_t i = 0; i < depths.size(); ++i)
        if (std::isfinite(depths[i]))
          expected[i] = getColor(frame, i);
      EXPECT_EQ(countDifferent(this->render(view.renderer), expected, rounding), 0);
      EXPECT_EQ(view.prop->GetBounds(), nullptr);
    }
}

TEST_F(ImageProp, SmallerImagesAreEnlarged) {
  View view(this->window);
  for (const bool isParallel : {false, true})
    for (const int part : {2, 4, 7}) {
      view.look({20.0, -300.0, 60.0}, isParallel);
      const Layer layer = this->show(view, Alpha::Hard, part);
      EXPECT_EQ(countDifferent(this->render(view.renderer), compose(layer, background), rounding),
                0);
      const std::vector<double> depths = readDepths(this->window, view.renderer);
      std::vector<double> opaque = layer.depths;
      for (std::size_t i = 0; i < opaque.size(); ++i)
        if (layer.colors[i][3] <= 254.5) // in the translucent pass
          opaque[i] = std::numeric_limits<double>::infinity();
      EXPECT_LT(compareDepths(depths, opaque), 0.01);
    }
}

TEST_F(ImageProp, EnlargedImagesAreBlendedAtTheDepthOfTheirEdge) {
  View view(this->window);
  const Model model({5.0, 60.0, -4.0}, 60.0); // all of it is behind the image's sphere
  view.renderer->AddActor(model.actor);
  const Layer layer = this->show(view, Alpha::Hard, 4);
  const auto [frame, depths] = this->renderModel(view);
  std::vector<Rgba> expected;
  for (std::size_t i = 0; i < depths.size(); ++i)
    expected.push_back(blend(layer.colors[i], getColor(frame, i)));
  EXPECT_EQ(countDifferent(this->render(view.renderer), expected, rounding), 0);
}

TEST_F(ImageProp, ViewsShowTheirOwnImages) {
  this->window->SetSize(480, 180);
  View left(this->window), right(this->window);
  left.renderer->SetViewport(0.0, 0.0, 0.5, 1.0);
  right.renderer->SetViewport(0.5, 0.0, 1.0, 1.0);
  right.look({250.0, 100.0, 20.0}, true);
  const Layer first = this->show(left, Alpha::Soft), second = this->show(right, Alpha::Soft, 2);
  const vtkNew<vtkRenderWindow> other;
  other->SetOffScreenRendering(1);
  other->SetMultiSamples(0);
  other->SetSize(200, 150);
  View third(other);
  other->Render();
  const auto traced = trace(third.renderer, 200, 150, Alpha::Soft);
  third.prop->SetImage(traced);
  for (int frame = 0; frame < 2; ++frame) {
    EXPECT_EQ(countDifferent(this->render(left.renderer), compose(first, background), rounding), 0);
    EXPECT_EQ(countDifferent(this->render(right.renderer), compose(second, background), rounding),
              0);
    EXPECT_EQ(countDifferent(views::renderImage(other, third.renderer),
                             compose(enlarge(*traced, 200, 150), background), rounding),
              0);
  }
  right.renderer->GetActiveCamera()->Azimuth(1.0);
  EXPECT_EQ(countDifferent(this->render(left.renderer), compose(first, background), rounding), 0);
  EXPECT_FALSE(right.prop->GetVisibility());
}

TEST_F(ImageProp, ImagesOfOtherCamerasAreHidden) {
  using Change = void (*)(vtkCamera*);
  const Change changes[] = {
      [](vtkCamera* camera) { camera->SetPosition(20.0, -300.0, 60.01); },
      [](vtkCamera* camera) { camera->SetFocalPoint(10.01, 0.0, 0.0); },
      [](vtkCamera* camera) { camera->SetViewUp(0.1, 0.2, 1.01); },
      [](vtkCamera* camera) { camera->SetViewAngle(20.01); },
      [](vtkCamera* camera) { camera->SetParallelProjection(!camera->GetParallelProjection()); },
      [](vtkCamera* camera) { camera->SetWindowCenter(0.01, 0.0); },
      [](vtkCamera* camera) { camera->SetUseOffAxisProjection(1); },
      [](vtkCamera* camera) { camera->SetParallelScale(55.01); }};
  View view(this->window);
  for (const bool isParallel : {false, true})
    for (std::size_t i = 0; i < std::size(changes); ++i) {
      if (i == (isParallel ? 3 : 7)) // the other projection's
        continue;
      const vtkNew<vtkCamera> camera;
      view.renderer->SetActiveCamera(camera);
      view.look({20.0, -300.0, 60.0}, isParallel);
      this->show(view, Alpha::Soft);
      const std::vector<unsigned char> shown = this->render(view.renderer).colors;
      EXPECT_TRUE(view.prop->FindPoint(120.0, 90.0));
      const vtkNew<vtkCamera> before;
      before->DeepCopy(camera);
      changes[i](camera);
      EXPECT_FALSE(view.prop->FindPoint(120.0, 90.0)) << "change " << i;
      EXPECT_EQ(view.prop->GetBounds(), nullptr);
      const Image frame = this->render(view.renderer);
      EXPECT_EQ(countDifferent(frame, std::vector<Rgba>(240 * 180, background), 0.0), 0);
      camera->DeepCopy(before);
      EXPECT_EQ(this->render(view.renderer).colors, shown);
    }
}

TEST_F(ImageProp, ResizedViewsHideTheImage) {
  View view(this->window);
  this->show(view, Alpha::Soft);
  const std::vector<unsigned char> shown = this->render(view.renderer).colors;
  const std::array<int, 2> sizes[] = {{241, 180}, {240, 179}, {480, 360}};
  for (const auto& [width, height] : sizes) {
    this->window->SetSize(width, height);
    const Image frame = this->render(view.renderer);
    const std::vector<Rgba> empty(static_cast<std::size_t>(width * height), background);
    EXPECT_EQ(countDifferent(frame, empty, 0.0), 0);
    EXPECT_FALSE(view.prop->GetVisibility());
  }
  this->window->SetSize(240, 180);
  EXPECT_EQ(this->render(view.renderer).colors, shown);
}

TEST_F(ImageProp, ClippingRangesKeepDepthsAndShaders) {
  View view(this->window);
  const vtkNew<BuildCounter> counter;
  counter->Attach(view.prop);
  for (const bool isParallel : {false, true}) {
    view.look({20.0, -300.0, 60.0}, isParallel);
    const Layer layer = this->show(view, Alpha::Hard);
    this->render(view.renderer);
    const int builds = counter->Builds;
    EXPECT_GE(builds, 1);
    const std::array<double, 2> ranges[] = {{200.0, 400.0}, {50.0, 2000.0}, {255.0, 320.0}};
    for (const auto& [nearest, farthest] : ranges) {
      view.renderer->GetActiveCamera()->SetClippingRange(nearest, farthest);
      this->render(view.renderer);
      EXPECT_LT(compareDepths(readDepths(this->window, view.renderer), layer.depths), 0.02);
    }
    this->show(view, Alpha::Hard);
    this->render(view.renderer);
    EXPECT_EQ(counter->Builds, builds);
  }
}

TEST_F(ImageProp, PickersFindTheSurface) {
  View view(this->window);
  const vtkNew<vtkCellPicker> picker;
  for (const bool isParallel : {false, true})
    for (const int part : {1, 2}) {
      view.look({20.0, -300.0, 60.0}, isParallel);
      this->show(view, Alpha::Soft, part);
      this->render(view.renderer);
      double byCells = 0.0, byDepth = 0.0;
      int clicks = 0, found = 0;
      for (int y = 2; y < 180; y += 5)
        for (int x = 2; x < 240; x += 5) {
          const double depth = intersect(view.renderer, 240, 180, x, 179 - y);
          const auto point = view.prop->FindPoint(x, y);
          EXPECT_TRUE(part > 1 || point.has_value() == std::isfinite(depth));
          byDepth = std::max(byDepth, point ? getDistance(*point) : 0.0);
          clicks += std::isfinite(depth) ? 1 : 0;
          if (!picker->Pick(x, y, 0.0, view.renderer))
            continue;
          ++found;
          EXPECT_EQ(picker->GetActor(), view.prop.Get());
          Point position;
          picker->GetPickPosition(position.data());
          byCells = std::max(byCells, getDistance(position));
        }
      std::cout << clicks << " clicks on the sphere, " << found
                << " found by vtkCellPicker, within " << byCells << " mm, by depth within "
                << byDepth << " mm\n";
      EXPECT_GT(found, 0.85 * clicks);
      EXPECT_LE(found, clicks + 5);
      EXPECT_LT(byCells, 0.6);
      EXPECT_LT(byDepth, part == 1 ? 0.001 : 2.0);
    }
}

TEST_F(ImageProp, PickersByRenderingFindTheSurface) {
  View view(this->window);
  const vtkNew<vtkWorldPointPicker> depth;
  const vtkNew<vtkPropPicker> prop;
  for (const bool isParallel : {false, true})
    for (const Alpha alpha : {Alpha::Hard, Alpha::Soft}) {
      view.look({20.0, -300.0, 60.0}, isParallel);
      this->show(view, alpha);
      const std::vector<unsigned char> colors = this->render(view.renderer).colors;
      for (int x = 40; x < 200; x += 20) {
        const bool isSphere = std::isfinite(intersect(view.renderer, 240, 180, x, 89));
        prop->Pick(x, 90.0, 0.0, view.renderer); // finds translucent pixels, too
        EXPECT_EQ(prop->GetActor() == view.prop.Get(), isSphere) << x;
        if (alpha == Alpha::Soft)
          continue;
        depth->Pick(x, 90.0, 0.0, view.renderer);
        Point position;
        depth->GetPickPosition(position.data());
        EXPECT_EQ(getDistance(position) < 0.6, isSphere) << x;
      }
      EXPECT_EQ(this->render(view.renderer).colors, colors);
    }
}

TEST_F(ImageProp, BoundsContainTheSurface) {
  View view(this->window);
  double bounds[6];
  for (const bool isParallel : {false, true}) {
    view.look({10.0, -300.0, 0.0}, isParallel); // sees all of the silhouette, nearly along y
    view.renderer->GetActiveCamera()->SetViewUp(0.0, 0.0, 1.0);
    this->show(view, Alpha::Soft);
    view.renderer->ComputeVisiblePropBounds(bounds);
    EXPECT_NEAR(bounds[0], center[0] - radius, 1.2);
    EXPECT_NEAR(bounds[1], center[0] + radius, 1.2);
    EXPECT_NEAR(bounds[2], center[1] - radius, 0.1);
    EXPECT_NEAR(bounds[4], center[2] - radius, 1.2);
    EXPECT_NEAR(bounds[5], center[2] + radius, 1.2);
    EXPECT_GT(bounds[3], bounds[2] + 0.7 * radius);
  }
  view.renderer->ResetCameraClippingRange();
  EXPECT_TRUE(view.prop->GetVisibility());
  view.prop->SetImage(nullptr);
  view.renderer->ComputeVisiblePropBounds(bounds);
  EXPECT_GT(bounds[0], bounds[1]) << "no image";
}

TEST_F(ImageProp, ScreenshotsEqualTheFrame) {
  for (const bool isParallel : {false, true}) {
    View view(this->window);
    view.look({20.0, -300.0, 60.0}, isParallel);
    view.renderer->GetActiveCamera()->SetViewAngle(21.3); // not exact as a float
    this->show(view, Alpha::Soft);
    const Image frame = this->render(view.renderer);
    const vtkNew<vtkWindowToImageFilter> filter;
    filter->SetInput(this->window);
    filter->ReadFrontBufferOff();
    filter->Update();
    Image found{240, 180, {}};
    for (int row = 179; row >= 0; --row) {
      const auto* first =
          static_cast<unsigned char*>(filter->GetOutput()->GetScalarPointer(0, row, 0));
      found.colors.insert(found.colors.end(), first, first + 3 * 240);
    }
    EXPECT_EQ(found.colors, frame.colors);
    filter->SetScale(2); // each tile has a camera of its own
    filter->Update();
    for (vtkIdType i = 0; i < filter->GetOutput()->GetNumberOfPoints(); i += 7)
      EXPECT_EQ(filter->GetOutput()->GetPointData()->GetScalars()->GetComponent(i, 1), 102.0);
    EXPECT_GT(countDifferent(found, std::vector<Rgba>(240 * 180, background), 0.0), 10000);
    this->window->RemoveRenderer(view.renderer);
  }
}

} // namespace
} // namespace image
