fenestra_test(SampleReadingTests SampleReadingTests.cxx
  LIBRARIES fenestra_io_medical TBB::tbb ZLIB::ZLIB LABELS unit)
