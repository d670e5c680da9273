#ifndef __qSlicerFenestraResults_h
#define __qSlicerFenestraResults_h

#include <QList>
#include <QString>
#include <QStringList>

#include "qSlicerFenestraModuleExport.h"
#include "vtkMRMLFenestraRenderNode.h"
#include <vtkWeakPointer.h>

/// \brief Where the files of this scene's renders lie: each render's in a folder of its own.
///
/// A result belongs to a node, not to the node's ID: IDs begin again with every scene.
class Q_SLICER_QTMODULES_FENESTRA_EXPORT qSlicerFenestraResults {
public:
  /// Also describes the node: by what the renderer says in the folder's statistics.
  void add(vtkMRMLFenestraRenderNode* render, const QString& folder);
  void clear() { m_all.clear(); }

  /// Empty where this session did not make the render.
  QString folderOf(vtkMRMLFenestraRenderNode* render) const;
  /// The picture as it was written, or empty.
  QString fileOf(vtkMRMLFenestraRenderNode* render, const QString& ending) const;
  /// The same of a turntable: its frames.
  QStringList framesOf(vtkMRMLFenestraRenderNode* turntable) const;
  /// Whether it is a turntable without all of its frames, whose scene is still there.
  bool lacksFrames(vtkMRMLFenestraRenderNode* render) const;

private:
  struct Result {
    vtkWeakPointer<vtkMRMLFenestraRenderNode> node; ///< null once the node is gone
    QString folder;
  };
  QList<Result> m_all;
};

#endif
