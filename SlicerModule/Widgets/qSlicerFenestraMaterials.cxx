#include "qSlicerFenestraMaterials.h"

#include "FenestraFlags.h"
#include "FenestraMaterials.h"
#include "qSlicerFenestraWidgets.h"
#include "ui_qSlicerFenestraMaterials.h"

#include <QAbstractItemView>
#include <QColorDialog>
#include <QFileDialog>
#include <QFileInfo>
#include <QMap>
#include <QScopedValueRollback>
#include <QWheelEvent>

#include <algorithm>

using namespace qSlicerFenestraWidgets;

namespace {

using Change = SlicerExport::MaterialChange;

enum Column { nameColumn, materialColumn, colorColumn, clipColumn, resetColumn, columns };

// Sources of materials: values of --materials, and two that stand for other values.
const QString none = "none", contrastSource = "contrast", library = "library";
const QString fileSource = "file", manualSource = "hand";

/// Ignores the wheel, which then scrolls the table instead of changing a material unnoticed.
class NoWheelComboBox : public QComboBox {
protected:
  void wheelEvent(QWheelEvent* event) override { event->ignore(); }
};

QIcon makeSwatch(const QString& color) {
  constexpr int side = 16; // pixels
  QPixmap pixels(side, side);
  pixels.fill(QColor(color));
  return pixels;
}

/// Tool tip with escaped text: names in a scene must not be read as HTML.
QString toPlainToolTip(const QString& text) {
  return "<qt>" + text.toHtmlEscaped() + "</qt>";
}

} // namespace

class qSlicerFenestraMaterialsPrivate : public Ui_qSlicerFenestraMaterials {
  Q_DECLARE_TR_FUNCTIONS(qSlicerFenestraMaterials)

public:
  template <typename Widget>
  Widget* cell(int row, int column) const {
    return qobject_cast<Widget*>(MaterialsTable->cellWidget(row, column));
  }
  QString source() const { return MaterialsBox->currentData().toString(); }
  QString base() const;
  Change findChange(const QString& segment) const;
  QString findId(const QString& selector) const;
  qFenestraMaterial findAutomatic(const QString& segment) const;
  QString findColor(const QString& segment) const;
  void showSource();
  void showRows();
  void showRow(int row);
  void setChanges(const std::vector<std::string>& texts);

  QString baseFlag; ///< flag `materials` to which manual changes apply
  QString manualText;
  QList<qSlicerFenestraSegment> segments;
  qFenestraMaterials known;
  QMap<QString, Change> changes; ///< by segment id
  bool showing = false;          ///< widgets are being set by the program, not by the user
};

qSlicerFenestraMaterials::qSlicerFenestraMaterials(QWidget* parent)
    : QWidget(parent), d_ptr(new qSlicerFenestraMaterialsPrivate) {
  Q_D(qSlicerFenestraMaterials);
  d->setupUi(this);
  setItemData(d->MaterialsBox, {"", none, library, contrastSource, fileSource, manualSource});
  d->manualText = d->MaterialsBox->itemText(d->MaterialsBox->findData(manualSource));
  buildTable();
  connect(d->MaterialsBox, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this, d] {
    if (!d->showing)
      onSource();
  });
  connect(d->MaterialsFile, &QLineEdit::editingFinished, this, &qSlicerFenestraMaterials::onFile);
  connect(d->MaterialsBrowse, &QToolButton::clicked, this, [this, d] {
    const QString file = QFileDialog::getOpenFileName(
        this, tr("Materials"), d->MaterialsFile->text(), tr("Materials (*.json)"));
    if (file.isEmpty())
      return;
    d->MaterialsFile->setText(file);
    onFile();
  });
  list({});
  d->showSource();
}

qSlicerFenestraMaterials::~qSlicerFenestraMaterials() = default;

void qSlicerFenestraMaterials::buildTable() {
  Q_D(qSlicerFenestraMaterials);
  d->MaterialsTable->verticalHeader()->hide();
  for (int i = 0; i < columns; ++i)
    d->MaterialsTable->horizontalHeader()->setSectionResizeMode(
        i, i == nameColumn || i == materialColumn ? QHeaderView::Stretch
                                                  : QHeaderView::ResizeToContents);
  connect(d->MaterialsTable, &QTableWidget::itemChanged, this,
          [this, d](const QTableWidgetItem* item) {
            if (item->column() == clipColumn && !d->showing)
              onClip(item->row());
          });
}

void qSlicerFenestraMaterials::buildRow(int row) {
  Q_D(qSlicerFenestraMaterials);
  auto* name = new QTableWidgetItem;
  name->setFlags(Qt::ItemIsEnabled);
  d->MaterialsTable->setItem(row, nameColumn, name);
  auto* material = new NoWheelComboBox;
  material->setFocusPolicy(Qt::StrongFocus);
  material->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  d->MaterialsTable->setCellWidget(row, materialColumn, material);
  auto* color = new QToolButton;
  d->MaterialsTable->setCellWidget(row, colorColumn, color);
  auto* clip = new QTableWidgetItem;
  clip->setFlags(Qt::ItemIsEnabled | Qt::ItemIsUserCheckable);
  d->MaterialsTable->setItem(row, clipColumn, clip);
  auto* reset = new QToolButton;
  reset->setText(QString::fromUtf8("\u21ba"));
  reset->setToolTip(tr("Reset to the automatic choice"));
  d->MaterialsTable->setCellWidget(row, resetColumn, reset);
  connect(material, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this, d, row] {
    if (!d->showing)
      onMaterial(row);
  });
  connect(color, &QToolButton::clicked, this, [this, row] { onColor(row); });
  connect(reset, &QToolButton::clicked, this, [this, row] { onReset(row); });
}

// ---- display

void qSlicerFenestraMaterials::list(const QList<qSlicerFenestraSegment>& segments) {
  Q_D(qSlicerFenestraMaterials);
  const QScopedValueRollback<bool> showing(d->showing, true);
  d->segments = segments;
  const int before = d->MaterialsTable->rowCount(), now = static_cast<int>(segments.size());
  d->MaterialsTable->setRowCount(now);
  for (int row = before; row < now; ++row)
    buildRow(row);
  d->MaterialsHint->setVisible(now == 0);
  setEnabled(now > 0);
  d->showRows();
}

void qSlicerFenestraMaterials::setKnownMaterials(const qFenestraMaterials& known) {
  Q_D(qSlicerFenestraMaterials);
  d->known = known;
  d->showRows();
}

/// Flag `materials` to which manual changes apply.
QString qSlicerFenestraMaterialsPrivate::base() const {
  const QString word = source();
  return word == manualSource ? baseFlag : word == fileSource ? MaterialsFile->text() : word;
}

/// Changes of a segment that are in the flags.
SlicerExport::MaterialChange
qSlicerFenestraMaterialsPrivate::findChange(const QString& segment) const {
  return source() == manualSource ? changes.value(segment) : Change();
}

/// Material that the renderer chooses. The choices of a user's file are unknown here.
qFenestraMaterial qSlicerFenestraMaterialsPrivate::findAutomatic(const QString& segment) const {
  const qFenestraMaterial one = known.bySegment.value(segment);
  const QString word = base();
  // Only the source "library" uses palette colors.
  const bool isUnknown = word != library && one.why == "by palette";
  if (word == none || isUnknown)
    return {{}, {}, tr("the volume's own colors"), true};
  if (!QStringList{"", contrastSource, library}.contains(word))
    return {{}, {}, tr("from the file"), true};
  return one;
}

/// Displayed color of the segment; empty: not known, or the volume's own.
QString qSlicerFenestraMaterialsPrivate::findColor(const QString& segment) const {
  const Change change = findChange(segment);
  const QString name = QString::fromStdString(change.field("material"));
  if (const QColor own(QString::fromStdString(change.field("color"))); own.isValid())
    return own.name();
  if (name.isEmpty())
    return findAutomatic(segment).color;
  const auto found = std::find_if(known.library.begin(), known.library.end(),
                                  [&name](const auto& one) { return one.name == name; });
  return found == known.library.end() ? QString() : found->color;
}

void qSlicerFenestraMaterialsPrivate::showSource() {
  const QString base = baseFlag == library          ? tr("the library")
                       : baseFlag == contrastSource ? tr("contrast")
                                                    : QFileInfo(baseFlag).fileName();
  MaterialsBox->setItemText(MaterialsBox->findData(manualSource),
                            baseFlag.isEmpty() ? manualText : tr("Manual, based on %1").arg(base));
  qSlicerFenestraWidgets::showRow(Form, MaterialsFileRow, source() == fileSource);
  setEnabled(MaterialsTable, source() != none, tr("Choose other materials above to change them"));
  showRows();
}

void qSlicerFenestraMaterialsPrivate::showRows() {
  for (int row = 0; row < MaterialsTable->rowCount(); ++row)
    showRow(row);
}

void qSlicerFenestraMaterialsPrivate::showRow(int row) {
  const QScopedValueRollback<bool> guard(showing, true);
  const auto& [id, name] = segments[row];
  const qFenestraMaterial own = findAutomatic(id);
  const Change change = findChange(id);
  MaterialsTable->item(row, nameColumn)->setText(name);
  auto* material = cell<QComboBox>(row, materialColumn);
  material->setAccessibleName(tr("Material of %1").arg(name));
  if (material->count() != known.library.size() + 1) {
    material->clear();
    material->addItem(QString(), QString());
    for (const qFenestraMaterial& one : known.library)
      material->addItem(one.color.isEmpty() ? QIcon() : makeSwatch(one.color), one.name, one.name);
    material->view()->setMinimumWidth(material->view()->sizeHintForColumn(0)); // full names
  }
  material->setItemText(0,
                        own.name.isEmpty() ? tr("Automatic") : tr("%1 (automatic)").arg(own.name));
  material->setToolTip(own.why.isEmpty() ? QString()
                                         : toPlainToolTip(tr("Automatic: %1").arg(own.why)));
  selectOrAdd(material, QString::fromStdString(change.field("material")));
  auto* color = cell<QToolButton>(row, colorColumn);
  color->setAccessibleName(tr("Color of %1").arg(name));
  const QString shownColor = findColor(id);
  color->setIcon(shownColor.isEmpty() ? QIcon() : makeSwatch(shownColor));
  color->setText(shownColor.isEmpty() ? tr("...") : QString());
  color->setToolTip(tr("Displayed color of the segment, sRGB %1").arg(shownColor));
  const std::string clip = change.field("clip");
  const bool isClipped = clip.empty() ? own.isClipped : clip != "no";
  MaterialsTable->item(row, clipColumn)->setCheckState(isClipped ? Qt::Checked : Qt::Unchecked);
  auto* reset = cell<QToolButton>(row, resetColumn);
  reset->setAccessibleName(tr("Reset %1").arg(name));
  setEnabled(reset, !change.fields.empty(), tr("This row has the automatic choice"));
}

// ---- user actions

/// Changes a row manually. Drops changes that were made before another source was chosen.
void qSlicerFenestraMaterials::change(int row, const std::map<std::string, QString>& fields) {
  Q_D(qSlicerFenestraMaterials);
  const QString& id = d->segments[row].id;
  if (d->source() != manualSource) {
    const QScopedValueRollback<bool> showing(d->showing, true);
    d->changes.clear();
    d->baseFlag = d->base();
    d->MaterialsBox->setCurrentIndex(d->MaterialsBox->findData(manualSource));
  }
  Change& change = d->changes[id];
  change.segment = id.toStdString();
  for (const auto& [key, value] : fields)
    change.set(key, value.toStdString());
  onSource();
}

/// Remembers the materials to which manual changes apply; by default the library.
void qSlicerFenestraMaterials::onSource() {
  Q_D(qSlicerFenestraMaterials);
  if (d->source() != manualSource)
    d->baseFlag = d->base();
  else if (d->baseFlag.isEmpty() || d->baseFlag == none)
    d->baseFlag = library;
  d->showSource();
  emit changed();
}

void qSlicerFenestraMaterials::onFile() {
  Q_D(qSlicerFenestraMaterials);
  if (d->MaterialsFile->text() != d->baseFlag)
    onSource();
}

/// A new material also replaces the color.
void qSlicerFenestraMaterials::onMaterial(int row) {
  Q_D(qSlicerFenestraMaterials);
  const QString name = d->cell<QComboBox>(row, materialColumn)->currentData().toString();
  change(row, {{"material", name}, {"color", {}}});
}

void qSlicerFenestraMaterials::onColor(int row) {
  Q_D(qSlicerFenestraMaterials);
  const auto [id, name] = d->segments[row];
  const QColor color =
      QColorDialog::getColor(QColor(d->findColor(id)), this, tr("Displayed color of %1").arg(name));
  const bool isListed = row < d->segments.size() && d->segments[row].id == id; // may have changed
  if (color.isValid() && isListed)
    change(row, {{"color", color.name()}});
}

void qSlicerFenestraMaterials::onClip(int row) {
  Q_D(qSlicerFenestraMaterials);
  const bool isClipped = d->MaterialsTable->item(row, clipColumn)->checkState() == Qt::Checked;
  const bool isAutomatic = isClipped == d->findAutomatic(d->segments[row].id).isClipped;
  change(row, {{"clip", isAutomatic ? QString() : isClipped ? "yes" : "no"}});
}

void qSlicerFenestraMaterials::onReset(int row) {
  Q_D(qSlicerFenestraMaterials);
  d->changes.remove(d->segments[row].id);
  d->showSource();
  emit changed();
}

// ---- flags

/// Id of the listed segment that a change selects; empty: none.
QString qSlicerFenestraMaterialsPrivate::findId(const QString& selector) const {
  for (const auto member : {&qSlicerFenestraSegment::id, &qSlicerFenestraSegment::name})
    for (const qSlicerFenestraSegment& one : segments)
      if (one.*member == selector)
        return one.id;
  return {};
}

void qSlicerFenestraMaterialsPrivate::setChanges(const std::vector<std::string>& texts) {
  for (const qSlicerFenestraSegment& one : segments)
    changes.remove(one.id);
  for (const std::string& text : texts) {
    Change given = SlicerExport::parseMaterialChange(text);
    const QString selector = QString::fromStdString(given.segment);
    const QString id = segments.isEmpty() ? selector : findId(selector); // list() comes later
    if (id.isEmpty())
      continue;
    given.segment = id.toStdString();
    given.fields.insert(changes[id].fields.begin(), changes[id].fields.end()); // earlier texts
    changes[id] = given;
  }
}

void qSlicerFenestraMaterials::show(const Flags& flags) {
  Q_D(qSlicerFenestraMaterials);
  const QString stored = findFlag(flags, "materials"),
                given = stored == "auto" ? contrastSource : stored; // its former name
  const auto texts = SlicerExport::splitList(findFlag(flags, "material").toStdString());
  const bool isManual = !texts.empty() || (d->source() == manualSource && given == d->baseFlag);
  const bool isFile = !given.isEmpty() && d->MaterialsBox->findData(given) < 0;
  const bool isNoFileYet =
      given.isEmpty() && d->source() == fileSource && d->MaterialsFile->text().isEmpty();
  const bool isNotPassed = d->segments.isEmpty() && given.isEmpty() && texts.empty();
  if (isNotPassed || (isNoFileYet && !isManual))
    return;
  const QScopedValueRollback<bool> showing(d->showing, true);
  if (isFile)
    d->MaterialsFile->setText(given);
  d->MaterialsBox->setCurrentIndex(d->MaterialsBox->findData(isManual ? manualSource
                                                             : isFile ? fileSource
                                                                      : given));
  d->baseFlag = given;
  if (isManual)
    d->setChanges(texts);
  d->showSource();
}

void qSlicerFenestraMaterials::reset() {
  Q_D(qSlicerFenestraMaterials);
  const QScopedValueRollback<bool> showing(d->showing, true);
  d->changes.clear();
  d->baseFlag.clear();
  d->MaterialsFile->clear();
  d->MaterialsBox->setCurrentIndex(0);
  d->showSource();
}

void qSlicerFenestraMaterials::take(Flags& flags) const {
  Q_D(const qSlicerFenestraMaterials);
  std::vector<std::string> texts;
  for (const qSlicerFenestraSegment& one : d->segments)
    if (const Change change = d->findChange(one.id); !change.fields.empty())
      texts.push_back(SlicerExport::toText(change));
  flags["materials"] = d->segments.isEmpty() ? "" : d->base().toStdString();
  flags["material"] = SlicerExport::joinList(texts);
}
