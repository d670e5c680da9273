foreach(idea MrmlDocument MrmlScene SceneFiles ScenePlan SlicerPresets)
  fenestra_test(${idea}Tests ${idea}Tests.cxx APART
    LIBRARIES fenestra_io_mrml fenestra_itk PkgConfig::LibZip LABELS unit)
endforeach()
