#ifndef __qSlicerFenestra3DViews_h
#define __qSlicerFenestra3DViews_h

#include <QSize>

class qMRMLThreeDWidget;
class vtkMRMLNode;

namespace qSlicerFenestra3DViews {

/// The widget of a 3D view; null as `view`: of the first one; null: there is none.
qMRMLThreeDWidget* findWidget(vtkMRMLNode* view);
/// Size in pixels of a 3D view, or else of the first one; empty: there is none, or it is hidden.
QSize findSize(vtkMRMLNode* view);

} // namespace qSlicerFenestra3DViews

#endif
