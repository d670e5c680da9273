#include "qSlicerSubjectHierarchyFenestraPlugin.h"

#include "vtkMRMLFenestraOpeningNode.h"
#include "vtkMRMLFenestraRenderNode.h"
#include "vtkSlicerFenestraLogic.h"

#include <qSlicerSubjectHierarchyDefaultPlugin.h>
#include <qSlicerSubjectHierarchyPluginHandler.h>

#include <vtkMRMLScalarVolumeNode.h>
#include <vtkMRMLScene.h>
#include <vtkMRMLSegmentationNode.h>
#include <vtkMRMLSubjectHierarchyNode.h>

#include <QAction>

namespace {

/// The segment of an item; empty: it is no segment.
std::string getSegmentId(vtkMRMLSubjectHierarchyNode* hierarchy, vtkIdType item) {
  return hierarchy->GetItemAttribute(item, vtkMRMLSegmentationNode::GetSegmentIDAttributeName());
}

} // namespace

qSlicerSubjectHierarchyFenestraPlugin::qSlicerSubjectHierarchyFenestraPlugin(
    vtkSlicerFenestraLogic* logic, QObject* parent)
    : Superclass(parent), m_logic(logic), m_openAction(new QAction(tr("Open in the view"), this)) {
  this->m_Name = "Fenestra";
  m_openAction->setObjectName("FenestraOpenAction");
  m_openAction->setToolTip(tr("Cuts the volume rendering in the 3D views in front of the focus"));
  connect(m_openAction, &QAction::triggered, this,
          &qSlicerSubjectHierarchyFenestraPlugin::openCurrentItem);
}

vtkMRMLSubjectHierarchyNode* qSlicerSubjectHierarchyFenestraPlugin::hierarchy() const {
  return qSlicerSubjectHierarchyPluginHandler::instance()->subjectHierarchyNode();
}

vtkMRMLFenestraOpeningNode*
qSlicerSubjectHierarchyFenestraPlugin::findOpening(vtkIdType item) const {
  return hierarchy() ? vtkMRMLFenestraOpeningNode::SafeDownCast(hierarchy()->GetItemDataNode(item))
                     : nullptr;
}

double
qSlicerSubjectHierarchyFenestraPlugin::canAddNodeToSubjectHierarchy(vtkMRMLNode* node,
                                                                    vtkIdType /*parent*/) const {
  return vtkMRMLFenestraOpeningNode::SafeDownCast(node) ? 1.0 : 0.0;
}

double qSlicerSubjectHierarchyFenestraPlugin::canOwnSubjectHierarchyItem(vtkIdType item) const {
  return findOpening(item) ? 1.0 : 0.0;
}

const QString qSlicerSubjectHierarchyFenestraPlugin::roleForPlugin() const {
  return "Opened view";
}

const QString qSlicerSubjectHierarchyFenestraPlugin::helpText() const {
  return tr("<p>The eye of the <b>opened view</b> cuts the volume rendering in the 3D views in "
            "front of the focus, or shows it uncut.</p>");
}

QString qSlicerSubjectHierarchyFenestraPlugin::tooltip(vtkIdType /*item*/) const {
  return tr("Volume rendering, cut in front of the focus (Fenestra module)");
}

QIcon qSlicerSubjectHierarchyFenestraPlugin::icon(vtkIdType /*item*/) {
  return QIcon(":/Icons/Fenestra.png");
}

QIcon qSlicerSubjectHierarchyFenestraPlugin::visibilityIcon(int visible) {
  return qSlicerSubjectHierarchyPluginHandler::instance()->defaultPlugin()->visibilityIcon(visible);
}

void qSlicerSubjectHierarchyFenestraPlugin::setDisplayVisibility(vtkIdType item, int visible) {
  vtkMRMLFenestraOpeningNode* opening = findOpening(item);
  if (opening != m_logic->GetOpening())
    return;
  if (opening && visible)
    m_logic->OpenView(opening->GetSettings());
  else if (opening)
    opening->SetVisible(false);
}

int qSlicerSubjectHierarchyFenestraPlugin::getDisplayVisibility(vtkIdType item) const {
  vtkMRMLFenestraOpeningNode* opening = findOpening(item);
  if (!opening || opening != m_logic->GetOpening())
    return -1; // a copy, which opens nothing
  return opening->GetVisible() ? 1 : 0;
}

QList<QAction*> qSlicerSubjectHierarchyFenestraPlugin::visibilityContextMenuActions() const {
  return {m_openAction};
}

void qSlicerSubjectHierarchyFenestraPlugin::showVisibilityContextMenuActionsForItem(
    vtkIdType item) {
  if (!hierarchy() || !item)
    return;
  const bool isSegment = !getSegmentId(hierarchy(), item).empty();
  const vtkMRMLNode* node = hierarchy()->GetItemDataNode(item);
  const bool isVolume = node && QString(node->GetClassName()) == "vtkMRMLScalarVolumeNode";
  auto* settings = vtkMRMLFenestraRenderNode::SafeDownCast(
      hierarchy()->GetScene()->GetSingletonNode("Settings", "vtkMRMLFenestraRenderNode"));
  m_openAction->setVisible(isSegment || (isVolume && vtkSlicerFenestraLogic::HasFocus(settings)));
}

void qSlicerSubjectHierarchyFenestraPlugin::openCurrentItem() {
  const vtkIdType item = qSlicerSubjectHierarchyPluginHandler::instance()->currentItem();
  if (!hierarchy() || !item)
    return;
  const std::string segment = getSegmentId(hierarchy(), item);
  if (segment.empty())
    m_logic->OpenVolume(vtkMRMLScalarVolumeNode::SafeDownCast(hierarchy()->GetItemDataNode(item)));
  else
    m_logic->OpenSegment(vtkMRMLSegmentationNode::SafeDownCast(
                             hierarchy()->GetItemDataNode(hierarchy()->GetItemParent(item))),
                         segment);
}
