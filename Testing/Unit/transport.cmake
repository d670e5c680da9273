fenestra_test(MediumTests PiecewiseLinearTests.cxx MajorantGridTests.cxx WideCellsTests.cxx VolumeTests.cxx
  LIBRARIES fenestra_tracking LABELS unit)
fenestra_test(ScatteringTests ScatteringTests.cxx LIBRARIES fenestra_medium LABELS unit)
fenestra_test(LightTests LightSetTests.cxx LIBRARIES fenestra_lights LABELS unit)
fenestra_test(RenderTests BackgroundTests.cxx CoverageTests.cxx EmptyPixelsTests.cxx FilmTests.cxx DeterminismTests.cxx SamplePlanTests.cxx StopTests.cxx LIBRARIES fenestra_render LABELS unit)
fenestra_test(OrganPresetsTests OrganPresetsTests.cxx
  LIBRARIES fenestra_scene fenestra_resources LABELS unit)
fenestra_test(AutomaticViewTests AutomaticViewTests.cxx
  LIBRARIES fenestra_scene TBB::tbb LABELS unit slow)
fenestra_test(SceneTests DefaultsTests.cxx SceneChangeTests.cxx
  LIBRARIES fenestra_scene medical_files TBB::tbb LABELS unit)
