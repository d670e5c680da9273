#ifndef __qSlicerFenestraMargins_h
#define __qSlicerFenestraMargins_h

#include <QList>
#include <QScopedPointer>
#include <QWidget>

class qSlicerFenestraMarginsPrivate;

struct qSlicerFenestraSegment {
  QString id, name;

  bool operator==(const qSlicerFenestraSegment& other) const {
    return id == other.id && name == other.name;
  }
};

/// Margins in mm by which the focus segments grow: one for all, or one per segment.
class qSlicerFenestraMargins : public QWidget {
  Q_OBJECT

public:
  explicit qSlicerFenestraMargins(QWidget* parent = nullptr);
  ~qSlicerFenestraMargins() override;

  /// Shows the numbers of the flag `margin`, in the order of the segments.
  void show(const QString& flag, const QList<qSlicerFenestraSegment>& focus);
  QString flag() const;

signals:
  void changed();

protected:
  QScopedPointer<qSlicerFenestraMarginsPrivate> d_ptr;

private:
  Q_DECLARE_PRIVATE(qSlicerFenestraMargins)
  Q_DISABLE_COPY(qSlicerFenestraMargins)

  void build(const QList<qSlicerFenestraSegment>& focus);
};

#endif
