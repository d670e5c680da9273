#include "qSlicerFenestraWidgets.h"

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QComboBox>
#include <QFile>
#include <QFormLayout>
#include <QHash>
#include <QIcon>
#include <QLabel>
#include <QObject>
#include <QSignalBlocker>

namespace {

constexpr int addedRole = Qt::UserRole + 1;          ///< true: the item was added by selectOrAdd
constexpr const char* helpProperty = "FenestraHelp"; ///< tool tip of the enabled widget

} // namespace

void qSlicerFenestraWidgets::setItemData(QComboBox* box, const QStringList& data) {
  Q_ASSERT(box->count() == data.size());
  for (int i = 0; i < box->count(); ++i)
    box->setItemData(i, data[i]);
}

void qSlicerFenestraWidgets::setItemIcons(QComboBox* box, const QString& kind) {
  for (int i = 0; i < box->count(); ++i) {
    const QString file = QString(":/Icons/%1-%2.png").arg(kind, box->itemData(i).toString());
    if (QFile::exists(file))
      box->setItemIcon(i, QIcon(file));
  }
  box->view()->setIconSize({48, 48});
}

void qSlicerFenestraWidgets::setChoiceOffered(QComboBox* box, int index, const Choice& choice,
                                              bool offered) {
  const QSignalBlocker blocker(box);
  const int found = box->findData(choice.data);
  if (offered && found < 0)
    box->insertItem(index, choice.text, choice.data);
  if (!offered && found >= 0)
    box->removeItem(found);
}

void qSlicerFenestraWidgets::selectData(QComboBox* box, const QString& data) {
  const int index = box->findData(data);
  box->setCurrentIndex(index < 0 ? 0 : index);
}

void qSlicerFenestraWidgets::selectOrAdd(QComboBox* box, const QString& data) {
  if (!data.isEmpty() && box->findData(data) < 0) {
    const QString text = data.startsWith('{') ? QObject::tr("As stored (JSON)") : data;
    int at = box->findData(true, addedRole);
    if (at < 0) {
      at = box->count();
      box->addItem(text);
    }
    box->setItemText(at, text);
    box->setItemData(at, data);
    box->setItemData(at, true, addedRole);
  }
  selectData(box, data);
}

std::string qSlicerFenestraWidgets::selectedData(const QComboBox* box) {
  return box->currentData().toString().toStdString();
}

void qSlicerFenestraWidgets::showRow(const QFormLayout* form, QWidget* editor, bool shown) {
  editor->setVisible(shown);
  if (QWidget* label = form->labelForField(editor))
    label->setVisible(shown);
}

void qSlicerFenestraWidgets::setEnabled(QWidget* widget, bool enabled, const QString& whatEnables) {
  if (!widget->property(helpProperty).isValid())
    widget->setProperty(helpProperty, widget->toolTip());
  widget->setEnabled(enabled);
  widget->setToolTip(enabled ? widget->property(helpProperty).toString() : whatEnables);
}

void qSlicerFenestraWidgets::nameParts(QWidget* panel) {
  QHash<const QWidget*, QString> labels;
  for (const QLabel* label : panel->findChildren<QLabel*>())
    if (label->buddy())
      labels[label->buddy()] = label->text().remove('&');
  for (QWidget* part : panel->findChildren<QWidget*>()) {
    const auto* button = qobject_cast<QAbstractButton*>(part);
    if (part->focusPolicy() == Qt::NoFocus || (button && !button->text().isEmpty()))
      continue;
    QString name;
    for (const QWidget* one = part; one != panel && name.isEmpty(); one = one->parentWidget())
      name = one->accessibleName().isEmpty() ? labels.value(one) : one->accessibleName();
    part->setAccessibleName(name);
  }
}

QString qSlicerFenestraWidgets::findFlag(const std::map<std::string, std::string>& flags,
                                         const char* name) {
  const auto found = flags.find(name);
  return found == flags.end() ? QString() : QString::fromStdString(found->second);
}

std::string qSlicerFenestraWidgets::toLimitFlag(double value) {
  return value > 0.0 ? QString::number(value, 'g', 6).toStdString() : std::string();
}
