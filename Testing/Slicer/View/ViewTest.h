#pragma once
// Base of tests that render on software OpenGL.

#include <vtkNew.h>
#include <vtkOutputWindow.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include <gtest/gtest.h>

#include <vector>

namespace views {

/// Counts messages of VTK, and prints them.
class MessageCounter : public vtkOutputWindow {
public:
  static MessageCounter* New();
  vtkTypeMacro(MessageCounter, vtkOutputWindow);
  void DisplayText(const char* text) override;

  int Count = 0;
};

struct Image {
  int width, height;
  std::vector<unsigned char> colors; ///< red, green and blue, the upper row first
};

/// Renders, and reads a renderer's part of the window.
Image renderImage(vtkRenderWindow* window, vtkRenderer* renderer);

/// Lets the window render 240 x 180 pixels off screen.
void setUpWindow(vtkRenderWindow* window);

/// Skips without OpenGL. Fails with messages of VTK.
class ViewTest : public ::testing::Test {
protected:
  void SetUp() override;
  void TearDown() override;
  /// Fails with errors of OpenGL.
  Image render(vtkRenderer* renderer);

  const vtkNew<MessageCounter> messages;
  const vtkNew<vtkRenderWindow> window; ///< from setUpWindow()
};

} // namespace views
