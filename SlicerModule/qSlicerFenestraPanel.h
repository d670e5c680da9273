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

/// The module's widgets from top to bottom, without behavior.
class qSlicerFenestraPanel : public QWidget {
  Q_OBJECT

public:
  explicit qSlicerFenestraPanel(QWidget* parent = nullptr);

  /// Shows the choices that the renderer supports.
  void setCapabilities(const qFenestraCapabilities& capabilities);
  /// Adds or removes the view choice of the anatomy preset; data: "preset".
  void offerPresetView(bool chosen);
  /// Shows the withheld flags of the scene; `files`: some of them name files.
  void showWithheld(const std::map<std::string, std::string>& what, bool files);

  QPushButton* sample;
  qMRMLNodeComboBox* volume;
  qMRMLNodeComboBox* segmentation;
  QComboBox* preset; ///< hidden if the renderer has none
  QListWidget* focus;
  QLabel* focusHint;
  QLabel* withheld;   ///< withheld flags of the scene; hidden if there are none
  QPushButton* allow; ///< allows the withheld files
  qSlicerFenestraClipping* clipping;
  qSlicerFenestraMaterials* materials;

  QComboBox* view; ///< data: value of the flag `view`; empty: the camera of a 3D view
  qMRMLNodeComboBox* view3D;
  QCheckBox* follow; ///< follow the camera of the 3D view live
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
  QDoubleSpinBox* steady; ///< degrees; 0: off
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
  QPushButton* back; ///< restores the layout before the image was shown
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
