fenestra_test(ClippingTests
  ClipKindTests.cxx
  ClipTests.cxx
  ContourTests.cxx
  DepthBufferTests.cxx
  FocusDepthTests.cxx
  GridWalkTests.cxx
  KernelSumsTests.cxx
  SeamsTests.cxx
  SmoothFillTests.cxx
  SurfaceChangeTests.cxx
  SurfaceMeshTests.cxx
  ThinPlateSplineTests.cxx
  LIBRARIES fenestra_clipping hwy::hwy
  LABELS unit)
