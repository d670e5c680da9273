#ifndef __qSlicerFenestraWidgets_h
#define __qSlicerFenestraWidgets_h

#include <QIcon>
#include <QList>
#include <QString>

#include <map>
#include <string>

class QComboBox;
class QFormLayout;
class QWidget;

/// Helpers of the panel's widgets.
namespace qSlicerFenestraWidgets {

/// Item of a combo box; `data` is a flag's value.
struct Choice {
  QString text, data;
  QIcon icon = {};
};

QComboBox* makeComboBox(const QString& name, const QList<Choice>& all, const QString& help);
/// Adds or removes a choice at `index`; the selection stays.
void setChoiceOffered(QComboBox* box, int index, const Choice& choice, bool offered);
/// Selects the item with `data`, else the first.
void selectData(QComboBox* box, const QString& data);
/// Selects the item with `data`; adds one where there is none, in place of the last that was added.
void selectOrAdd(QComboBox* box, const QString& data);
std::string selectedData(const QComboBox* box);

void showRow(const QFormLayout* form, QWidget* editor, bool shown);

/// Value of a flag; empty: not given.
QString findFlag(const std::map<std::string, std::string>& flags, const char* name);

} // namespace qSlicerFenestraWidgets

#endif
