#include "qSlicerFenestra3DViews.h"

#include <qMRMLThreeDView.h>
#include <qMRMLThreeDWidget.h>
#include <qSlicerApplication.h>
#include <qSlicerLayoutManager.h>

#include <vtkMRMLViewNode.h>

qMRMLThreeDWidget* qSlicerFenestra3DViews::findWidget(vtkMRMLNode* view) {
  const qSlicerApplication* application = qSlicerApplication::application();
  qSlicerLayoutManager* layout = application ? application->layoutManager() : nullptr;
  for (int i = 0; layout && i < layout->threeDViewCount(); ++i)
    if (qMRMLThreeDWidget* widget = layout->threeDWidget(i);
        widget && (!view || widget->mrmlViewNode() == view))
      return widget;
  return nullptr;
}

QSize qSlicerFenestra3DViews::findSize(vtkMRMLNode* view) {
  constexpr int least = 64; // pixels; a smaller one is collapsed
  const qMRMLThreeDWidget* widget = findWidget(view);
  if (!widget)
    widget = findWidget(nullptr);
  if (!widget || !widget->isVisible())
    return {};
  const QWidget* area = widget->threeDView();
  const QSize size = area->size() * area->devicePixelRatioF();
  return qMin(size.width(), size.height()) < least ? QSize() : size;
}
