#ifndef __qSlicerFenestraQuality_h
#define __qSlicerFenestraQuality_h

#include <QScopedPointer>
#include <QWidget>

#include <map>
#include <string>

class qSlicerFenestraQualityPrivate;

/// Widgets for the flags of quality, size and turntable.
class qSlicerFenestraQuality : public QWidget {
  Q_OBJECT

public:
  using Flags = std::map<std::string, std::string>;

  explicit qSlicerFenestraQuality(QWidget* parent = nullptr);
  ~qSlicerFenestraQuality() override;

  void setHasVolume(bool has);
  void show(const Flags& flags);
  /// Writes the flags; empty: not passed.
  void take(Flags& flags) const;

signals:
  void changed();
  void turntableRequested();

protected:
  QScopedPointer<qSlicerFenestraQualityPrivate> d_ptr;

private:
  Q_DECLARE_PRIVATE(qSlicerFenestraQuality)
  Q_DISABLE_COPY(qSlicerFenestraQuality)

  void takeLimits();
};

#endif
