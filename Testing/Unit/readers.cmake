fenestra_test(VolumePropertyTests VolumePropertyTests.cxx LIBRARIES fenestra_medium LABELS unit)
fenestra_test(VolumeReaderTests VolumeReaderTests.cxx
  LIBRARIES fenestra_io_read fenestra_itk LABELS unit)
fenestra_test(SegmentationReaderTests SegmentationReaderTests.cxx
  LIBRARIES fenestra_io_read fenestra_itk LABELS unit)
fenestra_test(TransferReaderTests TransferReaderTests.cxx
  LIBRARIES fenestra_io_read fenestra_itk LABELS unit)
fenestra_test(LightReaderTests LightReaderTests.cxx
  LIBRARIES fenestra_io_read fenestra_io_pictures fenestra_resources fenestra_itk LABELS unit)
