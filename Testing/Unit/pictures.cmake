find_package(OpenEXR REQUIRED)

fenestra_test(ImageIoTests ImageIoTests.cxx
  LIBRARIES fenestra_io_pictures fenestra_resources OpenEXR::OpenEXR LABELS unit)
fenestra_test(DisplayTransformTests DisplayTransformTests.cxx
  LIBRARIES fenestra_io_pictures LABELS unit)
fenestra_test(CompareTests CompareTests.cxx
  LIBRARIES fenestra_film fenestra_io_pictures LABELS unit)
fenestra_test(OutputsTests OutputsTests.cxx LIBRARIES fenestra_io LABELS unit)
