// Scale bar and orientation letters on display images. A wrong side would be dangerous.

#include "files/images/Annotations.h"

#include "Support.h"
#include "files/images/TextBitmap.h"
#include "scene/Defaults.h"
#include "scene/FilmImage.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::AnnotationsTests {
namespace {

/// Values of one channel, row 0 at the top.
struct Patch {
  int width = 0, height = 0;
  std::vector<float> values = {};

  float at(int x, int y) const { return values[static_cast<std::size_t>(y * width + x)]; }
  Patch crop(int left, int top, int right, int bottom) const {
    Patch part{right - left, bottom - top};
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x)
        part.values.push_back(at(x, y));
    return part;
  }
  /// Smallest part with all values above 0.
  Patch trim() const {
    int left = width, top = height, right = 0, bottom = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        if (at(x, y) > 0.0F) {
          left = std::min(left, x), right = std::max(right, x + 1);
          top = std::min(top, y), bottom = std::max(bottom, y + 1);
        }
    return right > left ? crop(left, top, right, bottom) : Patch{};
  }
  bool operator==(const Patch&) const = default;
};

/// Red channel of an image of uniform gray and alpha, with marks.
Patch drawOver(const Annotations& annotations, const ImagePlane& plane, int width, int height,
               float gray = 0.0F, float alpha = 1.0F, int channel = 0) {
  std::vector<float> rgba;
  for (int i = 0; i < width * height; ++i)
    rgba.insert(rgba.end(), {gray, gray, gray, alpha});
  drawAnnotations(annotations, plane, width, height, rgba);
  Patch patch{width, height};
  for (std::size_t i = static_cast<std::size_t>(channel); i < rgba.size(); i += 4)
    patch.values.push_back(rgba[i]);
  return patch;
}

Patch makeText(const std::string& text, int shorterSide) {
  const TextBitmap line = rasterizeText(text, {.size = 0.036 * shorterSide});
  return Patch{line.width, line.height, line.coverage}.trim();
}

constexpr int size = 512;
constexpr Annotations scaleOnly = {.scale = true}, orientationOnly = {.orientation = true};

struct EdgeLetters {
  std::string left, right, top, bottom;
};

/// Compares the text at the middle of each edge.
void expectLetters(const Camera& camera, const EdgeLetters& expected) {
  const Patch image = drawOver(orientationOnly, makeImagePlane(camera), size, size);
  constexpr int third = size / 3, middle = 2 * third;
  const auto text = [](const std::string& letters) { return makeText(letters, size); };
  EXPECT_EQ(image.crop(0, third, third, middle).trim(), text(expected.left)) << expected.left;
  EXPECT_EQ(image.crop(middle, third, size, middle).trim(), text(expected.right)) << expected.right;
  EXPECT_EQ(image.crop(third, 0, middle, third).trim(), text(expected.top)) << expected.top;
  EXPECT_EQ(image.crop(third, middle, middle, size).trim(), text(expected.bottom))
      << expected.bottom;
}

/// The letter at an edge is that of the patient's side that the camera projects toward it.
char findProjectedSide(const Camera& camera, const Vec2& edge) {
  const auto project = [&camera](const Vec3& point) {
    const Vec3 view = camera.toView(point);
    return camera.toRaster({view.x(), view.y()});
  };
  const Vec3 target = camera.pose().target;
  char best = ' ';
  double farthest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      const Vec3 point = target + 10.0 * sign * Vec3::Unit(axis);
      const double distance = (project(point) - project(target)).dot(edge);
      if (distance > farthest) {
        farthest = distance;
        best = (sign < 0.0 ? "LPI" : "RAS")[axis];
      }
    }
  return best;
}

TEST(Orientation, LettersOfEveryViewNameThePatientsSides) {
  struct Case {
    std::string view;
    std::optional<Vec3> position;
    EdgeLetters letters;
  };
  const Grid grid = makeCenteredGrid({40, 30, 20}, {2.0, 2.0, 2.0});
  for (const Case& c : std::vector<Case>{{"anterior", {}, {"R", "L", "S", "I"}},
                                         {"posterior", {}, {"L", "R", "S", "I"}},
                                         {"left", {}, {"A", "P", "S", "I"}},
                                         {"right", {}, {"P", "A", "S", "I"}},
                                         {"superior", {}, {"L", "R", "A", "P"}},
                                         {"inferior", {}, {"R", "L", "A", "P"}},
                                         {"", Vec3(-500, 300, 0), {"AR", "PL", "S", "I"}},
                                         {"", Vec3(500, 300, 0), {"PR", "AL", "S", "I"}}}) {
    SCOPED_TRACE(c.view + c.letters.left);
    ViewRequest view;
    view.position = c.position;
    if (!c.position)
      view.name = c.view;
    const Camera camera(frameView(view, grid, nullptr, size, size), size, size);
    expectLetters(camera, c.letters);
    EXPECT_EQ(c.letters.left[0], findProjectedSide(camera, {-1, 0}));
    EXPECT_EQ(c.letters.right[0], findProjectedSide(camera, {1, 0}));
    EXPECT_EQ(c.letters.top[0], findProjectedSide(camera, {0, -1}));
    EXPECT_EQ(c.letters.bottom[0], findProjectedSide(camera, {0, 1}));
  }
}

TEST(Orientation, LettersNameTheNearestOf26Directions) {
  EXPECT_EQ(toPatientLetters({2, 0, 0}), "R");
  EXPECT_EQ(toPatientLetters({0, -0.1, 0}), "P");
  EXPECT_EQ(toPatientLetters({0.41, 0, -1}), "I") << "22.3 degrees from inferior";
  EXPECT_EQ(toPatientLetters({0.42, 0, -1}), "IR") << "22.8 degrees from inferior";
  EXPECT_EQ(toPatientLetters({-1, 0.9, 0.3}), "LA");
  EXPECT_EQ(toPatientLetters({-1, 0.9, 0.8}), "LAS");
}

TEST(ScaleBar, LengthIsRoundAndAboutAFifthOfTheWidth) {
  EXPECT_EQ(chooseScaleLength(256.0), 50.0);
  EXPECT_EQ(chooseScaleLength(40.0), 10.0);
  for (double width = 1e-3; width < 1e6; width *= 1.07) {
    const double length = chooseScaleLength(width);
    EXPECT_GT(length, 0.126 * width);
    EXPECT_LT(length, 0.317 * width);
    const double power = std::pow(10.0, std::floor(std::log10(length) + 1e-9));
    const double factor = length / power;
    EXPECT_LT(std::min({std::abs(factor - 1), std::abs(factor - 2), std::abs(factor - 5)}), 1e-9)
        << length;
  }
}

TEST(ScaleBar, PixelsEqualTheStatedLength) {
  struct Case {
    int width, height;
    Vec3 columnStep;
    double length; ///< mm
  };
  for (const Case& c : {Case{512, 512, {-0.37, 0, 0}, 50}, Case{512, 512, {0, 0.53, 0}, 50},
                        Case{1024, 640, {0.03, 0.04, 0}, 10}, Case{640, 1024, {0, 0, 1.7}, 200},
                        Case{2048, 2048, {0.0011, 0, 0}, 0.5}}) {
    const std::string text = toString(c.length) + " mm";
    SCOPED_TRACE(text);
    const ImagePlane plane{Vec3::Zero(), c.columnStep, -c.columnStep.norm() * Vec3::UnitZ()};
    const Patch image = drawOver(scaleOnly, plane, c.width, c.height).trim();
    double pixels = 0.0; // of the lowest row, which the bar fills
    for (int x = 0; x < image.width; ++x)
      pixels += image.at(x, image.height - 1);
    EXPECT_NEAR(pixels * c.columnStep.norm(), c.length, 0.01 * c.columnStep.norm());
    EXPECT_GT(image.width, 0.125 * c.width);
    const Patch label = makeText(text, std::min(c.width, c.height));
    EXPECT_EQ(image.crop(0, 0, image.width, label.height).trim(), label);
  }
}

TEST(Annotations, AreOpaqueAndVisibleOnBlackAndWhite) {
  const Annotations both = {true, true};
  const auto draw = [&](float gray, float alpha, int channel) {
    return drawOver(both, {}, 128, 96, gray, alpha, channel).values;
  };
  const std::vector<float> onBlack = draw(0.0F, 1.0F, 0), onWhite = draw(1.0F, 1.0F, 0),
                           onNothing = draw(0.5F, 0.0F, 0), alpha = draw(0.5F, 0.0F, 3);
  EXPECT_GT(std::ranges::count(onBlack, 1.0F), 20);
  EXPECT_GT(std::ranges::count(onWhite, 0.0F), 20) << "outline";
  int unchanged = 0;
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    EXPECT_NEAR(onWhite[i], alpha[i] * onNothing[i] + 1.0F - alpha[i], 1e-6F);
    EXPECT_TRUE(onBlack[i] < 1.0F || alpha[i] == 1.0F);
    if (alpha[i] == 0.0F && onWhite[i] == 1.0F && onBlack[i] == 0.0F)
      ++unchanged;
  }
  EXPECT_GT(unchanged, 128 * 96 * 3 / 4);
}

/// Marks that do not fit are cut off.
TEST(Annotations, FitEveryImage) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(3, 200), std::pair(200, 3)})
    EXPECT_EQ(drawOver({true, true}, {}, width, height).values.size(),
              static_cast<std::size_t>(width * height));
}

} // namespace
} // namespace fenestra::core::testing::AnnotationsTests
