#ifndef __qSlicerFenestraMaterials_h
#define __qSlicerFenestraMaterials_h

#include "FenestraMaterials.h"
#include "qFenestraMaterials.h"
#include "qSlicerFenestraMargins.h"

#include <QMap>
#include <QWidget>

#include <map>
#include <string>

class QComboBox;
class QFormLayout;
class QLineEdit;
class QTableWidget;
class QToolButton;

/// \brief Materials of the segments: their source, and a table of the user's changes with one row
/// per segment.
///
/// Only differences from the automatic choice become flags. Needs Qt, but not Slicer.
class qSlicerFenestraMaterials : public QWidget {
  Q_OBJECT

public:
  using Flags = std::map<std::string, std::string>;

  explicit qSlicerFenestraMaterials(QWidget* parent = nullptr);

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

private:
  using Change = SlicerExport::MaterialChange;

  void buildSource(QFormLayout* form);
  void buildTable(QFormLayout* form);
  void buildRow(int row);
  void showSource();
  void showRows();
  void showRow(int row);
  void setChanges(const std::vector<std::string>& texts);
  void onSource();
  void onFile();
  void onMaterial(int row);
  void onColor(int row);
  void onClip(int row);
  void onReset(int row);
  void change(int row, const std::map<std::string, QString>& fields);
  QString source() const;
  QString base() const;
  Change findChange(const QString& segment) const;
  QString findId(const QString& selector) const;
  qFenestraMaterial findAutomatic(const QString& segment) const;
  QString findColor(const QString& segment) const;
  template <typename Widget>
  Widget* cell(int row, int column) const;

  QFormLayout* m_form;
  QComboBox* m_source;
  QWidget* m_fileRow;
  QLineEdit* m_file;
  QTableWidget* m_table;
  QString m_base = {}; ///< flag `materials` to which manual changes apply
  QList<qSlicerFenestraSegment> m_segments;
  qFenestraMaterials m_known;
  QMap<QString, Change> m_changes; ///< by segment id
  bool m_showing = false;          ///< widgets are being set by the program, not by the user
};

#endif
