find_package(pugixml REQUIRED)
fenestra_test(SurfaceWriterTests SurfaceWriterTests.cxx
  LIBRARIES fenestra_io_surfaces fenestra_io_medical pugixml::pugixml LABELS unit)
