#ifndef __qSlicerFenestraTurntable_h
#define __qSlicerFenestraTurntable_h

#include <QScopedPointer>
#include <QWidget>

#include <map>
#include <string>

class qSlicerFenestraTurntablePrivate;

/// Widgets for the flags of a turntable.
class qSlicerFenestraTurntable : public QWidget {
  Q_OBJECT

public:
  using Flags = std::map<std::string, std::string>;

  explicit qSlicerFenestraTurntable(QWidget* parent = nullptr);
  ~qSlicerFenestraTurntable() override;

  void setHasVolume(bool has);
  void show(const Flags& flags);
  /// Writes the flags; empty: not passed.
  void take(Flags& flags) const;

signals:
  void changed();
  void turntableRequested();

protected:
  QScopedPointer<qSlicerFenestraTurntablePrivate> d_ptr;

private:
  Q_DECLARE_PRIVATE(qSlicerFenestraTurntable)
  Q_DISABLE_COPY(qSlicerFenestraTurntable)
};

#endif
