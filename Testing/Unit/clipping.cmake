fenestra_test(ClippingTests
  GridWalkTests.cxx
  LIBRARIES fenestra_volume
  LABELS unit)
