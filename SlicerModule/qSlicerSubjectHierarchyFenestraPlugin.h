#ifndef __qSlicerSubjectHierarchyFenestraPlugin_h
#define __qSlicerSubjectHierarchyFenestraPlugin_h

#include <qSlicerSubjectHierarchyAbstractPlugin.h>

class vtkMRMLFenestraOpeningNode;
class vtkMRMLSubjectHierarchyNode;
class vtkSlicerFenestraLogic;

/// \brief The opened view in the data tree: an item with an eye, and "Open in the view" in the
/// context menus of segments and volumes.
class qSlicerSubjectHierarchyFenestraPlugin : public qSlicerSubjectHierarchyAbstractPlugin {
  Q_OBJECT

public:
  typedef qSlicerSubjectHierarchyAbstractPlugin Superclass;
  /// `logic` must outlive the plugin's use.
  explicit qSlicerSubjectHierarchyFenestraPlugin(vtkSlicerFenestraLogic* logic,
                                                 QObject* parent = nullptr);

  double canAddNodeToSubjectHierarchy(vtkMRMLNode* node, vtkIdType parent) const override;
  double canOwnSubjectHierarchyItem(vtkIdType item) const override;
  const QString roleForPlugin() const override;
  const QString helpText() const override;
  QString tooltip(vtkIdType item) const override;
  QIcon icon(vtkIdType item) override;
  QIcon visibilityIcon(int visible) override;
  void setDisplayVisibility(vtkIdType item, int visible) override;
  int getDisplayVisibility(vtkIdType item) const override;

  QList<QAction*> visibilityContextMenuActions() const override;
  void showVisibilityContextMenuActionsForItem(vtkIdType item) override;

private:
  vtkMRMLSubjectHierarchyNode* hierarchy() const;
  vtkMRMLFenestraOpeningNode* findOpening(vtkIdType item) const;
  void openCurrentItem();

  vtkSlicerFenestraLogic* m_logic;
  QAction* m_openAction;
};

#endif
