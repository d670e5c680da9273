find_package(nlohmann_json REQUIRED)
fenestra_test(PhantomTests
  PhantomKneeTests.cxx PhantomShapesTests.cxx PhantomWriterTests.cxx
  LIBRARIES fenestra_phantom fenestra_io_phantom fenestra_itk nlohmann_json::nlohmann_json TBB::tbb
  LABELS unit)
