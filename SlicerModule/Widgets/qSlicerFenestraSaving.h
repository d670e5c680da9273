#ifndef __qSlicerFenestraSaving_h
#define __qSlicerFenestraSaving_h

#include <QString>

class QWidget;
class qSlicerFenestraResults;
class vtkMRMLFenestraRenderNode;

namespace qSlicerFenestraSaving {

/// Asks for a file name, and before it replaces files, then saves the image or the frames of a
/// render. Returns a message for the user; empty: canceled.
QString save(vtkMRMLFenestraRenderNode* render, const qSlicerFenestraResults& results,
             QWidget* parent);

} // namespace qSlicerFenestraSaving

#endif
