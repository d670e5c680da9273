# The loadable module, the renderer as a command line module, and the package of both.
set(EXTENSION_NAME Fenestra)
set(EXTENSION_README_FILE "${PROJECT_SOURCE_DIR}/README.md")
set(EXTENSION_LICENSE_FILE "${PROJECT_SOURCE_DIR}/LICENSE")

set(BUILD_TESTING ${FENESTRA_BUILD_TESTS})
set(CMAKE_CXX_STANDARD 17) # what Slicer is built with; the renderer is not part of this scope
find_package(Slicer REQUIRED)
include(${Slicer_USE_FILE})

set(MODULE_NAME Fenestra)
# Slicer makes each module an attribute of slicer.modules, in lower case. The panel is `fenestra` there, so the
# renderer needs another name as a command line module.
set(COMMAND_MODULE_NAME FenestraCommand)
set(MODULE_TITLE "Fenestra")
string(TOUPPER ${MODULE_NAME} MODULE_NAME_UPPER)
# The renderer's folder for live display, standard C++17; nothing else of the renderer is included.
set(FENESTRA_PORTABLE_INCLUDE_DIR "${CMAKE_CURRENT_SOURCE_DIR}/../Renderer")
add_subdirectory(View)
add_subdirectory(MRML)
add_subdirectory(Logic)
add_subdirectory(MRMLDM)

include(Widgets/Widgets.cmake)
slicerMacroBuildLoadableModule(
  NAME ${MODULE_NAME}
  TITLE ${MODULE_TITLE}
  EXPORT_DIRECTIVE "Q_SLICER_QTMODULES_${MODULE_NAME_UPPER}_EXPORT"
  INCLUDE_DIRECTORIES ${CMAKE_CURRENT_SOURCE_DIR}/Logic ${CMAKE_CURRENT_BINARY_DIR}/Logic
                      ${CMAKE_CURRENT_SOURCE_DIR}/MRML ${CMAKE_CURRENT_BINARY_DIR}/MRML
                      ${CMAKE_CURRENT_SOURCE_DIR}/View ${CMAKE_CURRENT_SOURCE_DIR}/Widgets
                      ${FENESTRA_PORTABLE_INCLUDE_DIR}
                      ${qSlicerSubjectHierarchyModuleWidgets_INCLUDE_DIRS}
                      ${vtkSlicerFenestraModuleMRMLDisplayableManager_INCLUDE_DIRS}
  SRCS qSlicerFenestraApplicationSettings.cxx qSlicerFenestraApplicationSettings.h
       qSlicerFenestraImageClicks.cxx qSlicerFenestraImageClicks.h
       qSlicerFenestraLiveView.cxx qSlicerFenestraLiveView.h
       qSlicerFenestraModule.cxx qSlicerFenestraModule.h
       qSlicerFenestraModuleWidget.cxx qSlicerFenestraModuleWidget.h
       qSlicerFenestraResults.cxx qSlicerFenestraResults.h
       qSlicerFenestraSession.cxx qSlicerFenestraSession.h qSlicerFenestraSessionOpening.cxx
       qSlicerFenestraSessionPreview.cxx qSlicerFenestraSessionScripts.cxx
       qSlicerFenestraSettingsPanel.cxx qSlicerFenestraSettingsPanel.h
       qSlicerSubjectHierarchyFenestraPlugin.cxx qSlicerSubjectHierarchyFenestraPlugin.h
       ${widget_sources}
  MOC_SRCS qSlicerFenestraImageClicks.h qSlicerFenestraLiveView.h qSlicerFenestraModule.h
           qSlicerFenestraModuleWidget.h qSlicerFenestraSession.h qSlicerFenestraSettingsPanel.h
           qSlicerSubjectHierarchyFenestraPlugin.h
           ${widget_moc_sources}
  UI_SRCS Resources/UI/qSlicerFenestraModuleWidget.ui Resources/UI/qSlicerFenestraSettingsPanel.ui
          ${widget_ui_sources}
  TARGET_LIBRARIES vtkSlicer${MODULE_NAME}ModuleLogic
                   vtkSlicer${MODULE_NAME}ModuleMRMLDisplayableManager
                   qSlicerSubjectHierarchyModuleWidgets FenestraPortable
                   FenestraProcess FenestraScene FenestraView
  RESOURCES Resources/qSlicerFenestraModule.qrc
  WITH_GENERIC_TESTS)

# Libraries that the module links are exported with the module.
set_property(GLOBAL APPEND PROPERTY Slicer_TARGETS
  FenestraPortable FenestraProcess FenestraScene FenestraView fenestra_sanitizers fenestra_warnings)

# Sample data and self test: Slicer's modules for them are in Python.
if(Slicer_USE_PYTHONQT)
  slicerMacroBuildScriptedModule(NAME FenestraSelfTest SCRIPTS FenestraSelfTest.py
    RESOURCES Resources/Icons/preset-knee-cartilage.png)
endif()

include(Package.cmake)
if(BUILD_TESTING)
  add_subdirectory(Testing)
endif()

include(${Slicer_EXTENSION_GENERATE_CONFIG})
include(${Slicer_EXTENSION_CPACK})
