#ifndef __qSlicerFenestraLook_h
#define __qSlicerFenestraLook_h

#include <QScopedPointer>
#include <QWidget>

#include <map>
#include <string>

class qSlicerFenestraLookPrivate;

/// \brief Widgets for the appearance: tissue colors, lights, background, exposure, tone curve.
///
/// The renderer's defaults are not written as flags: the command line without them renders the same
/// image. The background is always a flag, because a scene saved by Slicer has its own background.
class qSlicerFenestraLook : public QWidget {
  Q_OBJECT

public:
  using Flags = std::map<std::string, std::string>;

  explicit qSlicerFenestraLook(QWidget* parent = nullptr);
  ~qSlicerFenestraLook() override;

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

protected:
  QScopedPointer<qSlicerFenestraLookPrivate> d_ptr;

private:
  Q_DECLARE_PRIVATE(qSlicerFenestraLook)
  Q_DISABLE_COPY(qSlicerFenestraLook)
};

#endif
