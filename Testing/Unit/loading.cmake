fenestra_test(SampleReadingTests SampleReadingTests.cxx
  LIBRARIES fenestra_io_medical fenestra_itk TBB::tbb ZLIB::ZLIB LABELS unit)
