#ifndef __qSlicerFenestraPanel_h
#define __qSlicerFenestraPanel_h

#include <QWidget>

#include <map>
#include <string>

class qMRMLNodeComboBox;
class qSlicerFenestraClipping;
class qSlicerFenestraLook;
class qSlicerFenestraMaterials;
class qSlicerFenestraPlayer;
class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QFormLayout;
class QLabel;
class QListWidget;
class QProgressBar;
class QPushButton;
class QSpinBox;
class QToolButton;
class QVBoxLayout;
class vtkMRMLScene;
struct qFenestraCapabilities;

/// The module's widgets from top to bottom, without behaviour.
class qSlicerFenestraPanel : public QWidget {
  Q_OBJECT

public:
  explicit qSlicerFenestraPanel(QWidget* parent = nullptr);

  /// Adds choices that only newer renderers support.
  void setCapabilities(const qFenestraCapabilities& abilities);
  /// Adds or removes the view that the anatomy preset has; data: "preset".
  void offerPresetView(bool chosen);
  /// Shows flags of the scene that are withheld, name and value; `files`: some name files.
  void showWithheld(const std::map<std::string, std::string>& what, bool files);

  QPushButton* sample;
  qMRMLNodeComboBox* volume;
  qMRMLNodeComboBox* segmentation;
  QComboBox* preset; ///< hidden if the renderer has none
  QListWidget* focus;
  QLabel* focusHint;
  QLabel* withheld;   ///< flags of the scene that are withheld; hidden if there are none
  QPushButton* allow; ///< allows the withheld files
  qSlicerFenestraClipping* clipping;
  qSlicerFenestraMaterials* materials;

  QComboBox* view; ///< data: the flag's word; empty: the camera of a 3-D view
  qMRMLNodeComboBox* view3D;
  QCheckBox* follow; ///< follow the camera of the 3-D view live
  qSlicerFenestraLook* look;

  QComboBox* quality; ///< data: "samples noise seconds"; empty: values of the boxes
  QSpinBox* samples;
  QDoubleSpinBox* noise;   ///< 0: no limit
  QDoubleSpinBox* seconds; ///< 0: no limit
  QSpinBox* width;
  QSpinBox* height;

  QWidget* animation;
  QSpinBox* frames;
  QDoubleSpinBox* degrees;
  QDoubleSpinBox* steady; ///< degrees; 0: each frame by itself
  QPushButton* turn;

  QCheckBox* showPreview;
  QLabel* preview;
  QLabel* previewState;

  QPushButton* render;
  QPushButton* stop;
  QProgressBar* progress;
  QLabel* state;
  QToolButton* details;
  QLabel* detailsText;

  qMRMLNodeComboBox* renders;
  QLabel* description;
  qSlicerFenestraPlayer* player;
  QLabel* measures;
  QPushButton* show;
  QPushButton* back; ///< to the layout before the picture's
  QPushButton* repeat;
  QPushButton* resume;
  QPushButton* save;

signals:
  void mrmlSceneChanged(vtkMRMLScene* scene);

private:
  void buildSubject(QVBoxLayout* layout);
  void buildMaterials(QVBoxLayout* layout);
  void buildPreview(QVBoxLayout* layout);
  void buildView(QVBoxLayout* layout);
  void buildQuality(QVBoxLayout* layout);
  void buildRender(QVBoxLayout* layout);
  void buildAnimation(QVBoxLayout* layout);
  void buildResults(QVBoxLayout* layout);
  QFormLayout* addSection(QVBoxLayout* layout, const QString& title, bool collapsed);
  qMRMLNodeComboBox* makeNodeBox(const QString& type, const QString& name);

  QFormLayout* m_subject;
  QWidget* m_materials; ///< section of the materials; hidden if the renderer has none
};

#endif
