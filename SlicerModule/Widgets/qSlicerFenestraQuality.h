#ifndef __qSlicerFenestraQuality_h
#define __qSlicerFenestraQuality_h

#include <QScopedPointer>
#include <QWidget>

#include <map>
#include <string>

class qSlicerFenestraQualityPrivate;

/// Widgets for the flags of quality and size.
class qSlicerFenestraQuality : public QWidget {
  Q_OBJECT

public:
  using Flags = std::map<std::string, std::string>;

  explicit qSlicerFenestraQuality(QWidget* parent = nullptr);
  ~qSlicerFenestraQuality() override;

  /// Shows the flags. `viewSize`: factor and size as take() returned them, "2 1024x768"; used only
  /// if the size is the flag `size`.
  void show(const Flags& flags, const QString& viewSize);
  /// Writes the flags; empty: not passed. Returns factor and size of an image "as the 3D view";
  /// empty: the size is fixed.
  QString take(Flags& flags) const;
  /// Adapts the size of an image "as the 3D view" to a view of `pixels` (empty: unknown): changes
  /// the flag and returns the new `viewSize`. One larger than the maximum is reduced in proportion.
  QString followView(Flags& flags, const QString& viewSize, const QSize& pixels) const;

signals:
  void changed();

protected:
  QScopedPointer<qSlicerFenestraQualityPrivate> d_ptr;

private:
  Q_DECLARE_PRIVATE(qSlicerFenestraQuality)
  Q_DISABLE_COPY(qSlicerFenestraQuality)

  void takeLimits();
  void takeSize();
  void onSizeTyped();
};

#endif
