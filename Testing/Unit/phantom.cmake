find_package(nlohmann_json REQUIRED)
find_package(pugixml REQUIRED)
fenestra_test(PhantomTests
  PhantomCubeTests.cxx PhantomFetusTests.cxx PhantomFootTests.cxx PhantomKneeTests.cxx PhantomSceneTests.cxx
  PhantomShapesTests.cxx PhantomWriterTests.cxx
  LIBRARIES fenestra_phantom fenestra_io_phantom fenestra_io_medical fenestra_io_looks fenestra_itk
    nlohmann_json::nlohmann_json pugixml::pugixml PkgConfig::LibZip TBB::tbb
  LABELS unit slow WHOLE)
