foreach(idea MrmlDocument MrmlScene SceneFiles ScenePlan)
  fenestra_test(${idea}Tests ${idea}Tests.cxx
    LIBRARIES fenestra_io_mrml fenestra_itk PkgConfig::LibZip LABELS unit)
endforeach()
