#ifndef __qSlicerFenestraSettings_h
#define __qSlicerFenestraSettings_h

#include <ctkVTKObject.h>
#include <qMRMLWidget.h>

class qSlicerFenestraSettingsPrivate;
class vtkMRMLFenestraRenderNode;
class vtkMRMLNode;
class vtkSlicerFenestraLogic;
struct qFenestraMaterials;

/// \brief Widgets of a settings node; synchronized with the node in both directions.
///
/// Observes the nodes that the settings reference: volume, segmentation, camera and plane.
class qSlicerFenestraSettings : public qMRMLWidget {
  Q_OBJECT
  QVTK_OBJECT

public:
  explicit qSlicerFenestraSettings(QWidget* parent = nullptr);
  ~qSlicerFenestraSettings() override;

  /// The logic must outlive this widget.
  void setLogic(vtkSlicerFenestraLogic* logic);
  void setKnownMaterials(const qFenestraMaterials& known);
  /// Enables what needs a volume, and offers the sample without one.
  void setHasVolume(bool has);
  void setSampleEnabled(bool enabled);

  /// Shows a settings node, with defaults for unset references; null: none.
  void use(vtkMRMLFenestraRenderNode* node);
  vtkMRMLFenestraRenderNode* node() const;
  /// Copies the settings of a render, to repeat the render.
  void copy(vtkMRMLFenestraRenderNode* render);

public slots:
  /// Takes the present size of the 3D view, if the image's size follows it.
  void followViewSize();

signals:
  /// The settings, or a node that they reference, have changed.
  void changed();
  void sampleRequested();
  void turntableRequested();

protected:
  QScopedPointer<qSlicerFenestraSettingsPrivate> d_ptr;

private slots:
  void updateWidgetFromMRML();
  void updateMRMLFromWidget();
  void reset();
  void takePreset();
  void takeVolume(vtkMRMLNode* node);
  void takeSegmentation(vtkMRMLNode* node);
  void onDataChanged();
  void onPlaneMoved();

private:
  Q_DECLARE_PRIVATE(qSlicerFenestraSettings)
  Q_DISABLE_COPY(qSlicerFenestraSettings)

  void observe(vtkMRMLNode* volume, vtkMRMLNode* segmentation);
};

#endif
