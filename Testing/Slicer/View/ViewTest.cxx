#include "ViewTest.h"

#include <vtkObjectFactory.h>
#include <vtkUnsignedCharArray.h>

#include <GL/gl.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string>

namespace views {

vtkStandardNewMacro(MessageCounter);

namespace {

/// Empty: there is OpenGL. VTK ends the process where X is missing.
std::string findObstacle() {
  const vtkNew<vtkRenderWindow> window;
  const bool isX = std::strstr(window->GetClassName(), "XOpenGL") != nullptr;
  if (isX && !std::getenv("DISPLAY"))
    return "no X display";
  window->SetOffScreenRendering(1);
  return window->SupportsOpenGL() ? "" : "no OpenGL context";
}

} // namespace

void MessageCounter::DisplayText(const char* text) {
  ++this->Count;
  std::cerr << text << '\n';
}

Image renderImage(vtkRenderWindow* window, vtkRenderer* renderer) {
  window->Render();
  int width = 0, height = 0, left = 0, bottom = 0;
  renderer->GetTiledSizeAndOrigin(&width, &height, &left, &bottom);
  vtkNew<vtkUnsignedCharArray> pixels;
  window->GetPixelData(left, bottom, left + width - 1, bottom + height - 1, 0, pixels);
  Image image{width, height, {}};
  for (int row = height - 1; row >= 0; --row) {
    const unsigned char* first = pixels->GetPointer(3 * static_cast<vtkIdType>(row) * width);
    image.colors.insert(image.colors.end(), first, first + 3 * static_cast<std::ptrdiff_t>(width));
  }
  return image;
}

void setUpWindow(vtkRenderWindow* window) {
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(240, 180);
}

void ViewTest::SetUp() {
  static const std::string obstacle = findObstacle();
  if (!obstacle.empty())
    GTEST_SKIP() << obstacle;
  vtkOutputWindow::SetInstance(this->messages);
  setUpWindow(this->window);
}

void ViewTest::TearDown() {
  vtkOutputWindow::SetInstance(nullptr);
  EXPECT_EQ(this->messages->Count, 0);
}

Image ViewTest::render(vtkRenderer* renderer) {
  Image image = renderImage(this->window, renderer);
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  return image;
}

} // namespace views
