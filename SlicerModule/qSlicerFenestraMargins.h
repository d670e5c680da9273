#ifndef __qSlicerFenestraMargins_h
#define __qSlicerFenestraMargins_h

#include <QMap>
#include <QWidget>

class QCheckBox;
class QDoubleSpinBox;
class QFormLayout;

struct qSlicerFenestraSegment {
  QString id, name;
};

/// Margins in mm by which the focus segments grow: one for all, or one per segment.
class qSlicerFenestraMargins : public QWidget {
  Q_OBJECT

public:
  explicit qSlicerFenestraMargins(QWidget* parent = nullptr);

  /// Shows the numbers of the flag `margin`, in the order of the segments.
  void show(const QString& flag, const QList<qSlicerFenestraSegment>& focus);
  QString flag() const;

signals:
  void changed();

private:
  void build(const QList<qSlicerFenestraSegment>& focus);
  void showEach();

  QDoubleSpinBox* m_all;
  QCheckBox* m_each;
  QFormLayout* m_rows;
  QList<qSlicerFenestraSegment> m_focus;
  QList<QDoubleSpinBox*> m_boxes;  ///< one per focus segment
  QMap<QString, double> m_margins; ///< mm by segment id; kept for segments outside the focus
};

#endif
