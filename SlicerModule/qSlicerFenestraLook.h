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

/// \brief Widgets for the appearance: tissue colors, lights, background, exposure, tone curve.
///
/// The renderer's defaults are not written as flags: the command line without them renders the same
/// image. The background is always a flag, because a scene saved by Slicer has its own background.
class qSlicerFenestraLook : public QWidget {
  Q_OBJECT

public:
  using Flags = std::map<std::string, std::string>;

  explicit qSlicerFenestraLook(QWidget* parent = nullptr);

  /// Shows the controls that the renderer supports.
  void setCapabilities(const qFenestraCapabilities& capabilities);
  /// Shows the flags. `rig`: rig and strengths as take() returned them; used only if they produce
  /// the flag `lights`. `byPreset`: an anatomy preset sets what flags do not set.
  void show(const Flags& flags, const QString& rig, bool byPreset);
  /// Lets the preset, or the renderer, choose tissue colors and lights.
  void resetToPreset();
  /// Writes the appearance flags; empty: not passed. Returns rig and strengths in percent: "rig key
  /// fill rim environment".
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
  ctkSliderWidget* m_strengths[4]; ///< percent; key, fill, rim, environment
  QComboBox* m_background;
  QDoubleSpinBox* m_exposure;
  QComboBox* m_tone;
  double m_shownExposure = 0.0; ///< a flag outside the box's range stays until the box changes
  QString m_shownTone;
};

#endif
