#ifndef __qSlicerFenestraSettings_h
#define __qSlicerFenestraSettings_h

#include <ctkVTKObject.h>

#include <QObject>
#include <QString>

#include <map>
#include <string>

#include "qSlicerFenestraMargins.h"
#include "vtkMRMLFenestraRenderNode.h"
#include <vtkWeakPointer.h>

class qSlicerFenestraPanel;
class vtkMRMLNode;
class vtkSlicerFenestraLogic;

/// \brief Synchronizes a settings node and the panel, in both directions.
///
/// Observes the nodes that the settings reference: volume, segmentation, camera and plane.
class qSlicerFenestraSettings : public QObject {
  Q_OBJECT
  QVTK_OBJECT

public:
  /// Panel and logic must outlive this object.
  qSlicerFenestraSettings(qSlicerFenestraPanel* panel, vtkSlicerFenestraLogic* logic,
                          QObject* parent = nullptr);

  /// Connects the panel to a settings node, with defaults for unset references; null: disconnects.
  void use(vtkMRMLFenestraRenderNode* node);
  vtkMRMLFenestraRenderNode* node() const { return m_node; }
  /// Copies the settings of a render, to repeat the render.
  void copy(vtkMRMLFenestraRenderNode* render);

signals:
  /// The settings, or a node that they reference, have changed.
  void changed();

private slots:
  void show();
  void showSegments();
  void take();
  void takePreset();
  void takeQuality();
  void takeVolume(vtkMRMLNode* node);
  void takeSegmentation(vtkMRMLNode* node);
  void onDataChanged();
  void takeMaterials();
  void onPlaneMoved();

private:
  using Flags = std::map<std::string, std::string>;

  void connectPanel();
  void chooseDefaults();
  bool hasPreset() const;
  QList<qSlicerFenestraSegment> listFocusSegments() const;
  void observe(vtkWeakPointer<vtkMRMLNode>& watched, vtkMRMLNode* node);
  void observeCamera();
  void observePlane();
  void showSubject(const Flags& flags);
  void showView(const Flags& flags);
  void showQuality(const Flags& flags);
  void takeClipping(Flags& flags);
  void takeView(Flags& flags);

  qSlicerFenestraPanel* m_panel;
  vtkSlicerFenestraLogic* m_logic;
  vtkWeakPointer<vtkMRMLFenestraRenderNode> m_node;
  vtkWeakPointer<vtkMRMLNode> m_volume, m_segmentation, m_camera, m_plane; ///< observed
  bool m_showing = false; ///< the panel is being set by the program, not by the user
};

#endif
