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

/// \brief Materials of the segments: where they come from, and a table of one row a segment with
/// what the user changes of it.
///
/// Only what differs from the automatic choice becomes a flag. Needs Qt alone.
class qSlicerFenestraMaterials : public QWidget {
  Q_OBJECT

public:
  using Flags = std::map<std::string, std::string>;

  explicit qSlicerFenestraMaterials(QWidget* parent = nullptr);

  /// Lists the segments. The changes of one that is gone are no flag, but there again with it.
  void list(const QList<qSlicerFenestraSegment>& segments);
  /// Shows what the renderer chooses by itself, and what it offers.
  void setKnownMaterials(const qFenestraMaterials& known);
  /// Shows the flags. Without segments none is passed: the widgets stay as they are then.
  void show(const Flags& flags);
  /// Sets all widgets to defaults, and forgets all changes.
  void reset();
  /// Sets the flags; empty: not passed.
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
  QString m_base = {}; ///< flag `materials` beneath changes made by hand
  QList<qSlicerFenestraSegment> m_segments;
  qFenestraMaterials m_known;
  QMap<QString, Change> m_changes; ///< by the segments' ids
  bool m_showing = false;          ///< widgets are being set by the program, not by the user
};

#endif
