# ITK's own writers make the files of these tests.
find_package(ITK REQUIRED COMPONENTS
  ITKHDF5 ITKIOTransformHDF5 ITKIOTransformInsightLegacy ITKIOTransformMatlab)
fenestra_test(TransformFileTests TransformFileTests.cxx APART
  LIBRARIES fenestra_io_transforms fenestra_io_mrml fenestra_itk ${ITK_LIBRARIES} LABELS unit)
target_include_directories(TransformFileTests SYSTEM PRIVATE ${ITK_INCLUDE_DIRS})
find_package(ITK REQUIRED COMPONENTS ITKIOGDCM)
fenestra_test(DicomSeriesTests DicomSeriesTests.cxx APART
  LIBRARIES fenestra_io_medical fenestra_itk ${ITK_LIBRARIES} LABELS unit)
fenestra_test(ClosedSurfaceTests ClosedSurfaceTests.cxx
  LIBRARIES fenestra_io_medical ZLIB::ZLIB LABELS unit)
fenestra_test(ApartTests ApartTests.cxx APART LIBRARIES fenestra_io LABELS unit)
