#include "qSlicerFenestraMaterials.h"

#include "FenestraFlags.h"
#include "qSlicerFenestraWidgets.h"

#include <QAbstractItemView>
#include <QColorDialog>
#include <QComboBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QScopedValueRollback>
#include <QTableWidget>
#include <QToolButton>
#include <QWheelEvent>

#include <algorithm>

using namespace qSlicerFenestraWidgets;

namespace {

enum Column { nameColumn, materialColumn, colorColumn, clipColumn, resetColumn, columns };

// Sources of materials: values of --materials, and two that stand for other values.
const QString none = "none", automaticSource = "auto", library = "library";
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

qSlicerFenestraMaterials::qSlicerFenestraMaterials(QWidget* parent) : QWidget(parent) {
  m_form = new QFormLayout(this);
  m_form->setContentsMargins(0, 0, 0, 0);
  buildSource(m_form);
  buildTable(m_form);
  list({});
  showSource();
}

void qSlicerFenestraMaterials::buildSource(QFormLayout* form) {
  m_source = makeComboBox("MaterialsBox",
                          {{tr("Default"), ""},
                           {tr("None: the volume's colors"), none},
                           {tr("Automatic: distinguish the focus"), automaticSource},
                           {tr("Library"), library},
                           {tr("File"), fileSource},
                           {tr("Manual"), manualSource}},
                          tr("Colors of the segments, and whether they are clipped"));
  form->addRow(tr("Materials:"), m_source);
  m_fileRow = new QWidget;
  auto* row = new QHBoxLayout(m_fileRow);
  row->setContentsMargins(0, 0, 0, 0);
  m_file = new QLineEdit;
  m_file->setObjectName("MaterialsFile");
  m_file->setToolTip(tr("Your own materials (.json), which override the library"));
  auto* browse = new QToolButton;
  browse->setObjectName("MaterialsBrowse");
  browse->setText(tr("..."));
  browse->setToolTip(tr("Choose a file"));
  browse->setAccessibleName(browse->toolTip());
  row->addWidget(m_file, 1);
  row->addWidget(browse);
  form->addRow(tr("File:"), m_fileRow);
  connect(m_source, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this] {
    if (!m_showing)
      onSource();
  });
  connect(m_file, &QLineEdit::editingFinished, this, &qSlicerFenestraMaterials::onFile);
  connect(browse, &QToolButton::clicked, this, [this] {
    const QString file = QFileDialog::getOpenFileName(this, tr("Materials"), m_file->text(),
                                                      tr("Materials (*.json)"));
    if (file.isEmpty())
      return;
    m_file->setText(file);
    onFile();
  });
}

void qSlicerFenestraMaterials::buildTable(QFormLayout* form) {
  constexpr int maxHeight = 260; // pixels
  m_table = new QTableWidget(0, columns);
  m_table->setObjectName("MaterialsTable");
  m_table->setAccessibleName(tr("Materials of the segments"));
  m_table->setHorizontalHeaderLabels(
      {tr("Segment"), tr("Material"), tr("Color"), tr("Clip"), QString()});
  m_table->horizontalHeaderItem(clipColumn)
      ->setToolTip(tr("Unchecked: the segment is not clipped"));
  m_table->verticalHeader()->hide();
  m_table->setSelectionMode(QAbstractItemView::NoSelection);
  m_table->setMaximumHeight(maxHeight);
  for (int i = 0; i < columns; ++i)
    m_table->horizontalHeader()->setSectionResizeMode(i, i == nameColumn || i == materialColumn
                                                             ? QHeaderView::Stretch
                                                             : QHeaderView::ResizeToContents);
  form->addRow(m_table);
  connect(m_table, &QTableWidget::itemChanged, this, [this](const QTableWidgetItem* item) {
    if (item->column() == clipColumn && !m_showing)
      onClip(item->row());
  });
}

template <typename Widget>
Widget* qSlicerFenestraMaterials::cell(int row, int column) const {
  return qobject_cast<Widget*>(m_table->cellWidget(row, column));
}

void qSlicerFenestraMaterials::buildRow(int row) {
  auto* name = new QTableWidgetItem;
  name->setFlags(Qt::ItemIsEnabled);
  m_table->setItem(row, nameColumn, name);
  auto* material = new NoWheelComboBox;
  material->setFocusPolicy(Qt::StrongFocus);
  material->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  m_table->setCellWidget(row, materialColumn, material);
  auto* color = new QToolButton;
  m_table->setCellWidget(row, colorColumn, color);
  auto* clip = new QTableWidgetItem;
  clip->setFlags(Qt::ItemIsEnabled | Qt::ItemIsUserCheckable);
  m_table->setItem(row, clipColumn, clip);
  auto* reset = new QToolButton;
  reset->setText(QString::fromUtf8("\u21ba"));
  reset->setToolTip(tr("Reset to the automatic choice"));
  m_table->setCellWidget(row, resetColumn, reset);
  connect(material, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this, row] {
    if (!m_showing)
      onMaterial(row);
  });
  connect(color, &QToolButton::clicked, this, [this, row] { onColor(row); });
  connect(reset, &QToolButton::clicked, this, [this, row] { onReset(row); });
}

// ---- display

void qSlicerFenestraMaterials::list(const QList<qSlicerFenestraSegment>& segments) {
  const QScopedValueRollback<bool> showing(m_showing, true);
  m_segments = segments;
  const int before = m_table->rowCount(), now = static_cast<int>(segments.size());
  m_table->setRowCount(now);
  for (int row = before; row < now; ++row)
    buildRow(row);
  setEnabled(now > 0);
  showRows();
}

void qSlicerFenestraMaterials::setKnownMaterials(const qFenestraMaterials& known) {
  m_known = known;
  showRows();
}

QString qSlicerFenestraMaterials::source() const {
  return m_source->currentData().toString();
}

/// Flag `materials` to which manual changes apply.
QString qSlicerFenestraMaterials::base() const {
  const QString word = source();
  return word == manualSource ? m_base : word == fileSource ? m_file->text() : word;
}

/// Changes of a segment that are in the flags.
SlicerExport::MaterialChange qSlicerFenestraMaterials::findChange(const QString& segment) const {
  return source() == manualSource ? m_changes.value(segment) : Change();
}

/// Material that the renderer chooses. The choices of a user's file are unknown here.
qFenestraMaterial qSlicerFenestraMaterials::findAutomatic(const QString& segment) const {
  const qFenestraMaterial one = m_known.bySegment.value(segment);
  const QString word = base();
  // Only the source "library" uses palette colors.
  const bool isUnknown = word != library && one.why == "by palette";
  if (word == none || isUnknown)
    return {{}, {}, tr("the volume's own colors"), true};
  if (!QStringList{"", automaticSource, library}.contains(word))
    return {{}, {}, tr("from the file"), true};
  return one;
}

/// Displayed color of the segment; empty: not known, or the volume's own.
QString qSlicerFenestraMaterials::findColor(const QString& segment) const {
  const Change change = findChange(segment);
  const QString name = QString::fromStdString(change.field("material"));
  if (const QColor own(QString::fromStdString(change.field("color"))); own.isValid())
    return own.name();
  if (name.isEmpty())
    return findAutomatic(segment).color;
  const auto found = std::find_if(m_known.library.begin(), m_known.library.end(),
                                  [&name](const auto& one) { return one.name == name; });
  return found == m_known.library.end() ? QString() : found->color;
}

void qSlicerFenestraMaterials::showSource() {
  const QString base = m_base == library           ? tr("the library")
                       : m_base == automaticSource ? tr("the automatic choice")
                                                   : QFileInfo(m_base).fileName();
  m_source->setItemText(m_source->findData(manualSource),
                        m_base.isEmpty() ? tr("Manual") : tr("Manual, based on %1").arg(base));
  qSlicerFenestraWidgets::showRow(m_form, m_fileRow, source() == fileSource);
  m_table->setEnabled(source() != none);
  showRows();
}

void qSlicerFenestraMaterials::showRows() {
  for (int row = 0; row < m_table->rowCount(); ++row)
    showRow(row);
}

void qSlicerFenestraMaterials::showRow(int row) {
  const QScopedValueRollback<bool> showing(m_showing, true);
  const auto& [id, name] = m_segments[row];
  const qFenestraMaterial own = findAutomatic(id);
  const Change change = findChange(id);
  m_table->item(row, nameColumn)->setText(name);
  auto* material = cell<QComboBox>(row, materialColumn);
  material->setAccessibleName(tr("Material of %1").arg(name));
  if (material->count() != m_known.library.size() + 1) {
    material->clear();
    material->addItem(QString(), QString());
    for (const qFenestraMaterial& one : m_known.library)
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
  m_table->item(row, clipColumn)->setCheckState(isClipped ? Qt::Checked : Qt::Unchecked);
  auto* reset = cell<QToolButton>(row, resetColumn);
  reset->setAccessibleName(tr("Reset %1").arg(name));
  reset->setEnabled(!change.fields.empty());
}

// ---- user actions

/// Changes a row manually. Drops changes that were made before another source was chosen.
void qSlicerFenestraMaterials::change(int row, const std::map<std::string, QString>& fields) {
  const QString& id = m_segments[row].id;
  if (source() != manualSource) {
    const QScopedValueRollback<bool> showing(m_showing, true);
    m_changes.clear();
    m_base = base();
    m_source->setCurrentIndex(m_source->findData(manualSource));
  }
  Change& change = m_changes[id];
  change.segment = id.toStdString();
  for (const auto& [key, value] : fields)
    change.set(key, value.toStdString());
  onSource();
}

/// Remembers the materials to which manual changes apply; by default the automatic ones.
void qSlicerFenestraMaterials::onSource() {
  if (source() != manualSource)
    m_base = base();
  else if (m_base.isEmpty() || m_base == none)
    m_base = automaticSource;
  showSource();
  emit changed();
}

void qSlicerFenestraMaterials::onFile() {
  if (m_file->text() != m_base)
    onSource();
}

/// A new material also replaces the color.
void qSlicerFenestraMaterials::onMaterial(int row) {
  const QString name = cell<QComboBox>(row, materialColumn)->currentData().toString();
  change(row, {{"material", name}, {"color", {}}});
}

void qSlicerFenestraMaterials::onColor(int row) {
  const auto [id, name] = m_segments[row];
  const QColor color =
      QColorDialog::getColor(QColor(findColor(id)), this, tr("Displayed color of %1").arg(name));
  const bool isListed = row < m_segments.size() && m_segments[row].id == id; // may have changed
  if (color.isValid() && isListed)
    change(row, {{"color", color.name()}});
}

void qSlicerFenestraMaterials::onClip(int row) {
  const bool isClipped = m_table->item(row, clipColumn)->checkState() == Qt::Checked;
  const bool isAutomatic = isClipped == findAutomatic(m_segments[row].id).isClipped;
  change(row, {{"clip", isAutomatic ? QString() : isClipped ? "yes" : "no"}});
}

void qSlicerFenestraMaterials::onReset(int row) {
  m_changes.remove(m_segments[row].id);
  showSource();
  emit changed();
}

// ---- flags

/// Id of the listed segment that a change selects; empty: none.
QString qSlicerFenestraMaterials::findId(const QString& selector) const {
  for (const auto member : {&qSlicerFenestraSegment::id, &qSlicerFenestraSegment::name})
    for (const qSlicerFenestraSegment& one : m_segments)
      if (one.*member == selector)
        return one.id;
  return {};
}

void qSlicerFenestraMaterials::setChanges(const std::vector<std::string>& texts) {
  for (const qSlicerFenestraSegment& one : m_segments)
    m_changes.remove(one.id);
  for (const std::string& text : texts) {
    Change given = SlicerExport::parseMaterialChange(text);
    const QString selector = QString::fromStdString(given.segment);
    const QString id = m_segments.isEmpty() ? selector : findId(selector); // list() comes later
    if (id.isEmpty())
      continue;
    given.segment = id.toStdString();
    given.fields.insert(m_changes[id].fields.begin(), m_changes[id].fields.end()); // earlier texts
    m_changes[id] = given;
  }
}

void qSlicerFenestraMaterials::show(const Flags& flags) {
  const QString given = findFlag(flags, "materials");
  const auto texts = SlicerExport::splitList(findFlag(flags, "material").toStdString());
  const bool isManual = !texts.empty() || (source() == manualSource && given == m_base);
  const bool isFile = !given.isEmpty() && m_source->findData(given) < 0;
  const bool isNoFileYet = given.isEmpty() && source() == fileSource && m_file->text().isEmpty();
  const bool isNotPassed = m_segments.isEmpty() && given.isEmpty() && texts.empty();
  if (isNotPassed || (isNoFileYet && !isManual))
    return;
  const QScopedValueRollback<bool> showing(m_showing, true);
  if (isFile)
    m_file->setText(given);
  m_source->setCurrentIndex(m_source->findData(isManual ? manualSource
                                               : isFile ? fileSource
                                                        : given));
  m_base = given;
  if (isManual)
    setChanges(texts);
  showSource();
}

void qSlicerFenestraMaterials::reset() {
  const QScopedValueRollback<bool> showing(m_showing, true);
  m_changes.clear();
  m_base.clear();
  m_file->clear();
  m_source->setCurrentIndex(0);
  showSource();
}

void qSlicerFenestraMaterials::take(Flags& flags) const {
  std::vector<std::string> texts;
  for (const qSlicerFenestraSegment& one : m_segments)
    if (const Change change = findChange(one.id); !change.fields.empty())
      texts.push_back(SlicerExport::toText(change));
  flags["materials"] = m_segments.isEmpty() ? "" : base().toStdString();
  flags["material"] = SlicerExport::joinList(texts);
}
