#include "qSlicerFenestraWidgets.h"

#include <QComboBox>
#include <QFormLayout>
#include <QLabel>
#include <QObject>
#include <QSignalBlocker>

namespace {

constexpr int addedRole = Qt::UserRole + 1; ///< true: the item was added by selectOrAdd

} // namespace

QComboBox* qSlicerFenestraWidgets::makeComboBox(const QString& name, const QList<Choice>& all,
                                                const QString& help) {
  auto* box = new QComboBox;
  box->setObjectName(name);
  box->setToolTip(help);
  box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon); // for long texts
  for (const Choice& choice : all)
    box->addItem(choice.icon, choice.text, choice.data);
  return box;
}

void qSlicerFenestraWidgets::setChoiceOffered(QComboBox* box, int index, const Choice& choice,
                                              bool offered) {
  const QSignalBlocker blocker(box);
  const int found = box->findData(choice.data);
  if (offered && found < 0)
    box->insertItem(index, choice.icon, choice.text, choice.data);
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

QString qSlicerFenestraWidgets::findFlag(const std::map<std::string, std::string>& flags,
                                         const char* name) {
  const auto found = flags.find(name);
  return found == flags.end() ? QString() : QString::fromStdString(found->second);
}
