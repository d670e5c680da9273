foreach(idea MrmlDocument MrmlScene MrmlTransform SceneFiles ScenePlan SlicerPresets)
  fenestra_test(${idea}Tests ${idea}Tests.cxx APART
    LIBRARIES fenestra_io_mrml medical_files PkgConfig::LibZip LABELS unit)
endforeach()
fenestra_test(CostTests CostTests.cxx
  LIBRARIES fenestra_io_mrml LABELS unit slow)
