#ifndef __qSlicerFenestraWidgets_h
#define __qSlicerFenestraWidgets_h

#include <QString>
#include <QStringList>

#include <map>
#include <string>

class QComboBox;
class QFormLayout;
class QWidget;

namespace qSlicerFenestraWidgets {

/// Item of a combo box; `data` is a flag's value.
struct Choice {
  QString text, data;
};

/// Sets the flag values of the items, whose texts are in the .ui file.
void setItemData(QComboBox* box, const QStringList& data);
/// Gives the items icons: the resources "kind-data", where there is one. Only the list shows them
/// large: the box stays one line high.
void setItemIcons(QComboBox* box, const QString& kind);
/// Adds a choice at `index` or removes it; the selection stays.
void setChoiceOffered(QComboBox* box, int index, const Choice& choice, bool offered);
/// Selects the item with `data`, else the first.
void selectData(QComboBox* box, const QString& data);
/// Selects the item with `data`. A missing item is added, in place of the item added before.
void selectOrAdd(QComboBox* box, const QString& data);
std::string selectedData(const QComboBox* box);

void showRow(const QFormLayout* form, QWidget* editor, bool shown);
/// Enables a widget, or disables it with a tool tip that says what enables it.
void setEnabled(QWidget* widget, bool enabled, const QString& whatEnables);
/// Names the parts of compound widgets like the widgets, for screen readers: by the widget's own
/// name or text, else by its label.
void nameParts(QWidget* panel);

/// Value of a flag; empty: not set.
QString findFlag(const std::map<std::string, std::string>& flags, const char* name);
/// Value of a flag that limits something; empty (not passed): no limit.
std::string toLimitFlag(double value);

} // namespace qSlicerFenestraWidgets

#endif
