#ifndef __qSlicerFenestraPanel_h
#define __qSlicerFenestraPanel_h

#include <QWidget>

#include <map>
#include <string>

class ctkSliderWidget;
class qMRMLNodeComboBox;
class qSlicerFenestraClipping;
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
struct qFenestraAbilities;

/// The module's widgets from top to bottom, and nothing that they do.
class qSlicerFenestraPanel : public QWidget {
  Q_OBJECT

public:
  explicit qSlicerFenestraPanel(QWidget* parent = nullptr);

  /// Offers what only newer renderers know.
  void offer(const qFenestraAbilities& abilities);
  /// With an anatomy preset there are choices that are left to it: data "preset" for the view, and
  /// none for others.
  void offerPresets(bool chosen);
  /// What the scene says of flags and is not followed, word by word; `files`: it names files.
  void showWithheld(const std::map<std::string, std::string>& what, bool files);

  /// Chooses by data; the first where it is none of the choices. A file that the user allowed as
  /// the value of `flag` is made one of them.
  static void choose(QComboBox* box, const QString& data, const char* flag);
  static bool namesFile(const char* flag, const QString& value);

  QPushButton* sample;
  qMRMLNodeComboBox* volume;
  qMRMLNodeComboBox* segmentation;
  QComboBox* preset; ///< hidden where there are none
  QListWidget* focus;
  QLabel* focusHint;
  QLabel* withheld;   ///< what the scene says and is not followed; hidden where there is nothing
  QPushButton* allow; ///< those of it that are files
  qSlicerFenestraClipping* clipping;

  QComboBox* view; ///< data: the flag's word; empty: a 3-D view's camera
  qMRMLNodeComboBox* view3D;
  QCheckBox* follow; ///< the 3-D view's camera, live
  QComboBox* transfer;
  QComboBox* rig;
  ctkSliderWidget* strengths[4]; ///< per cent: key, fill, rim, environment
  QComboBox* background;

  QComboBox* quality; ///< data: "samples noise seconds"; none: as the boxes say
  QSpinBox* samples;
  QDoubleSpinBox* noise;   ///< 0: no limit
  QDoubleSpinBox* seconds; ///< 0: no limit
  QSpinBox* width;
  QSpinBox* height;

  QWidget* animation;
  QSpinBox* frames;
  QDoubleSpinBox* degrees;
  QDoubleSpinBox* steady; ///< degrees; 0: as each frame by itself
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
  QPushButton* repeat;
  QPushButton* resume;
  QPushButton* save;

signals:
  void mrmlSceneChanged(vtkMRMLScene* scene);

private:
  void buildSubject(QVBoxLayout* layout);
  void buildPreview(QVBoxLayout* layout);
  void buildView(QVBoxLayout* layout);
  void buildQuality(QVBoxLayout* layout);
  void buildRender(QVBoxLayout* layout);
  void buildAnimation(QVBoxLayout* layout);
  void buildResults(QVBoxLayout* layout);
  QFormLayout* section(QVBoxLayout* layout, const QString& title, bool collapsed);
  qMRMLNodeComboBox* nodes(const QString& type, const QString& name);

  QFormLayout* m_subject;
};

#endif
