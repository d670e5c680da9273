#ifndef __qSlicerFenestraMaterials_h
#define __qSlicerFenestraMaterials_h

#include "qFenestraMaterials.h"
#include "qSlicerFenestraMargins.h"

#include <QScopedPointer>
#include <QWidget>

#include <map>
#include <string>

class qSlicerFenestraMaterialsPrivate;

/// \brief Materials of the segments: their source, and a table of the user's changes with one row
/// per segment.
///
/// Only differences from the automatic choice become flags. Needs Qt, but not Slicer.
class qSlicerFenestraMaterials : public QWidget {
  Q_OBJECT

public:
  using Flags = std::map<std::string, std::string>;

  explicit qSlicerFenestraMaterials(QWidget* parent = nullptr);
  ~qSlicerFenestraMaterials() override;

  /// Lists the segments. Changes to a removed segment are not passed, but return with the segment.
  void list(const QList<qSlicerFenestraSegment>& segments);
  /// Sets the renderer's automatic choices and its material library.
  void setKnownMaterials(const qFenestraMaterials& known);
  /// Shows the flags. Empty flags are ignored without segments, since none are passed then.
  void show(const Flags& flags);
  /// Sets all widgets to their defaults and removes all changes.
  void reset();
  /// Writes the flags; empty: not passed.
  void take(Flags& flags) const;

signals:
  void changed();

protected:
  QScopedPointer<qSlicerFenestraMaterialsPrivate> d_ptr;

private:
  Q_DECLARE_PRIVATE(qSlicerFenestraMaterials)
  Q_DISABLE_COPY(qSlicerFenestraMaterials)

  void buildTable();
  void buildRow(int row);
  void onSource();
  void onFile();
  void onMaterial(int row);
  void onColor(int row);
  void onClip(int row);
  void onReset(int row);
  void change(int row, const std::map<std::string, QString>& fields);
};

#endif
