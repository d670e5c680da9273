#ifndef __qSlicerFenestraLook_h
#define __qSlicerFenestraLook_h

#include <QWidget>

#include <map>
#include <string>

class ctkSliderWidget;
class QComboBox;
class QDoubleSpinBox;
class QFormLayout;
struct qFenestraCapabilities;

/// \brief How the picture looks: widgets for tissue colours, lights, background, exposure and tone.
///
/// Defaults of the renderer are no flags: the command line without them makes the same picture. The
/// background is always a flag, for a scene that Slicer saves has one of its own.
class qSlicerFenestraLook : public QWidget {
  Q_OBJECT

public:
  using Flags = std::map<std::string, std::string>;

  explicit qSlicerFenestraLook(QWidget* parent = nullptr);

  /// Shows what only newer renderers support.
  void setCapabilities(const qFenestraCapabilities& abilities);
  /// Shows the flags. `rig`: rig and strengths as take() returned them; believed only if the flag
  /// of the lights follows from them. `byPreset`: an anatomy preset sets what other flags do not.
  void show(const Flags& flags, const QString& rig, bool byPreset);
  /// Leaves tissue colours and lights to the preset, or to the renderer.
  void resetToPreset();
  /// Sets the look's flags; empty: not passed. Returns rig and strengths, "rig key fill rim
  /// environment", strengths in per cent.
  QString take(Flags& flags) const;

signals:
  void changed();

private:
  void buildLights(QFormLayout* form);
  void buildDisplay(QFormLayout* form);
  void showLights(const QString& lights, const QString& rig);

  QFormLayout* m_form;
  QComboBox* m_transfer;
  QComboBox* m_rig;
  ctkSliderWidget* m_strengths[4]; ///< per cent; key, fill, rim, environment
  QComboBox* m_background;
  QDoubleSpinBox* m_exposure;
  QComboBox* m_tone;
  double m_shownExposure = 0.0; ///< of the box; a flag beyond its range stays until the box changes
  QString m_shownTone;
};

#endif
