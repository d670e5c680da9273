# The panel's widgets, each with its layout in Resources/UI. They are compiled into the module: only the module uses
# them, and a library of their own would contain a second copy of FenestraProcess, which is static.
set(widget_sources)
set(widget_moc_sources)
set(widget_ui_sources)
foreach(name Clipping Look Margins Materials Player Quality Settings Turntable)
  list(APPEND widget_sources Widgets/qSlicerFenestra${name}.cxx Widgets/qSlicerFenestra${name}.h)
  list(APPEND widget_moc_sources Widgets/qSlicerFenestra${name}.h)
  list(APPEND widget_ui_sources Resources/UI/qSlicerFenestra${name}.ui)
endforeach()
foreach(name 3DViews Lights Measures PreviewLabel Saving Widgets)
  list(APPEND widget_sources Widgets/qSlicerFenestra${name}.cxx Widgets/qSlicerFenestra${name}.h)
endforeach()
list(APPEND widget_sources Widgets/qSlicerFenestraAutomaticBox.h Widgets/qSlicerFenestraOpening.cxx
  Widgets/qSlicerFenestraOpening.h)
list(APPEND widget_moc_sources Widgets/qSlicerFenestraOpening.h)
