#ifndef __qSlicerFenestraResults_h
#define __qSlicerFenestraResults_h

#include <QList>
#include <QString>
#include <QStringList>

#include "qSlicerFenestraModuleExport.h"
#include "vtkMRMLFenestraRenderNode.h"
#include <vtkWeakPointer.h>

/// \brief Folders of this scene's renders, one per render.
///
/// Results are found by node, not by node ID: the next scene reuses the IDs.
class Q_SLICER_QTMODULES_FENESTRA_EXPORT qSlicerFenestraResults {
public:
  /// Stores the folder, and describes the node by the statistics in the folder. Removes the folders
  /// of deleted nodes.
  void add(vtkMRMLFenestraRenderNode* render, const QString& folder);
  void clear() { m_all.clear(); }

  /// Folder of a render; empty: not rendered in this session.
  QString findFolder(vtkMRMLFenestraRenderNode* render) const;
  /// Image file as the renderer wrote it; empty: none.
  QString findFile(vtkMRMLFenestraRenderNode* render, const QString& extension) const;
  /// The turntable's frame files; empty: none.
  QStringList findFrames(vtkMRMLFenestraRenderNode* turntable) const;
  /// True for a turntable with missing frames whose scene file still exists.
  bool lacksFrames(vtkMRMLFenestraRenderNode* render) const;

private:
  struct Result {
    vtkWeakPointer<vtkMRMLFenestraRenderNode> node; ///< null once the node is gone
    QString folder;
  };
  QList<Result> m_all;
};

#endif
