fenestra_test(ShownTextTests ShownTextTests.cxx LIBRARIES fenestra_io LABELS unit)
fenestra_test(VolumePropertyTests VolumePropertyTests.cxx LIBRARIES fenestra_medium LABELS unit)
fenestra_test(VolumeReaderTests VolumeReaderTests.cxx
  LIBRARIES fenestra_io_medical medical_files LABELS unit)
fenestra_test(SegmentationReaderTests SegmentationReaderTests.cxx SegmentTagsTests.cxx
  LIBRARIES fenestra_io_medical medical_files LABELS unit)
fenestra_test(TransferReaderTests TransferReaderTests.cxx
  LIBRARIES fenestra_io_looks LABELS unit)
fenestra_test(LightReaderTests LightReaderTests.cxx
  LIBRARIES fenestra_io_looks fenestra_io_pictures fenestra_resources LABELS unit)
fenestra_test(MaskShapingTests MaskShapingTests.cxx
  LIBRARIES fenestra_io_medical fenestra_clipping LABELS unit)
fenestra_test(PresetReaderTests PresetReaderTests.cxx
  LIBRARIES fenestra_io_looks fenestra_resources LABELS unit)
