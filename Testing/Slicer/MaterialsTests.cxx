// Table of the segments' materials, with the real renderer: display, arguments, and equality of
// their image with that of a typed command.

#include "TemporaryFolder.h"

#include "FenestraFlags.h"
#include "FenestraSceneFiles.h"
#include "qFenestraPreview.h"
#include "qFenestraQueue.h"
#include "qSlicerFenestraMaterials.h"

#include <QApplication>
#include <QColorDialog>
#include <QComboBox>
#include <QElapsedTimer>
#include <QLineEdit>
#include <QTableWidget>
#include <QTimer>
#include <QToolButton>
#include <gtest/gtest.h>

#include <functional>
#include <numeric>

namespace fenestra::core {
namespace {

using Flags = std::map<std::string, std::string>;
using Materials = qSlicerFenestraMaterials;

const QString program = FENESTRA_EXECUTABLE;

bool waitFor(const std::function<bool()>& condition) {
  constexpr int timeoutMs = 300'000; // of a program that hangs
  QElapsedTimer watch;
  watch.start();
  while (!condition() && watch.elapsed() < timeoutMs)
    QCoreApplication::processEvents(QEventLoop::AllEvents | QEventLoop::WaitForMoreEvents, 10);
  return condition();
}

enum Column { name, material, color, clip, reset };

/// Ids and names that would need escaping in a shell, a list or JSON.
const std::string awkward = "a, \"b\": c=d; $HOME 'e' \\, \xc3\xa9";
std::vector<SlicerExport::Segment> makeSegments() {
  return {{"Segment_1", "Liver", 1, 0, "", {0.9, 0.1, 0.1}},
          {awkward, "Aorta: 'x', \"y\"", 2, 0, "", {0.5, 0.5, 0.5}},
          {"Segment_3", "Thing", 3, 0, "", {0.2, 0.4, 0.8}}};
}

QList<qSlicerFenestraSegment> toPanelSegments(const std::vector<SlicerExport::Segment>& all) {
  QList<qSlicerFenestraSegment> list;
  for (const SlicerExport::Segment& one : all)
    list.append({QString::fromStdString(one.id), QString::fromStdString(one.name)});
  return list;
}

qFenestraMaterials queryMaterials(const std::vector<SlicerExport::Segment>& all,
                                  const TemporaryFolder& folder) {
  qFenestraMaterialsQuery query;
  std::vector<qFenestraMaterials> results;
  QObject::connect(&query, &qFenestraMaterialsQuery::received,
                   [&](const qFenestraMaterials& materials) { results.push_back(materials); });
  query.request(program, {}, QString::fromStdString(folder.path().string()));
  query.request(program, all, QString::fromStdString(folder.path().string()));
  EXPECT_TRUE(waitFor([&] { return !results.empty(); }));
  EXPECT_EQ(results.size(), 1u) << "an outdated query has no result";
  return results.empty() ? qFenestraMaterials() : results.back();
}

/// The renderer's materials for the segments, queried once.
const qFenestraMaterials& knownMaterials() {
  static const qFenestraMaterials materials = queryMaterials(makeSegments(), TemporaryFolder());
  return materials;
}

class SlicerMaterials : public ::testing::Test {
protected:
  SlicerMaterials() {
    table.list(toPanelSegments(makeSegments()));
    table.setKnownMaterials(knownMaterials());
  }

  QTableWidget& widget() { return *table.findChild<QTableWidget*>("MaterialsTable"); }
  QComboBox& source() { return *table.findChild<QComboBox*>("MaterialsBox"); }
  template <typename Widget>
  Widget& cell(int row, Column column) {
    return *qobject_cast<Widget*>(widget().cellWidget(row, column));
  }
  QString text(int row) { return widget().item(row, name)->text(); }
  void choose(const char* word) { source().setCurrentIndex(source().findData(word)); }
  std::string chosen() { return source().currentData().toString().toStdString(); }
  void setMaterial(int row, const char* materialName) {
    auto& box = cell<QComboBox>(row, material);
    box.setCurrentIndex(box.findData(materialName));
  }
  void setClip(int row, bool isClipped) {
    widget().item(row, clip)->setCheckState(isClipped ? Qt::Checked : Qt::Unchecked);
  }
  bool isClipped(int row) { return widget().item(row, clip)->checkState() == Qt::Checked; }
  /// Color on the row's button, or its text.
  QString shownColor(int row) {
    auto& button = cell<QToolButton>(row, color);
    return button.icon().isNull() ? button.text()
                                  : button.icon().pixmap(16).toImage().pixelColor(8, 8).name();
  }
  /// Presses the row's button and chooses a color in the dialog that opens.
  void pickColor(int row, const char* chosen) {
    QTimer::singleShot(0, [chosen] {
      auto* dialog = qobject_cast<QColorDialog*>(QApplication::activeModalWidget());
      ASSERT_NE(dialog, nullptr);
      dialog->setCurrentColor(QColor(chosen));
      dialog->accept();
    });
    cell<QToolButton>(row, color).click();
  }

  /// Nonempty flags.
  Flags takeFlags() const {
    Flags all, given;
    table.take(all);
    for (const auto& [name, value] : all)
      if (!value.empty())
        given[name] = value;
    return given;
  }
  std::vector<std::string> arguments() const { return SlicerExport::toArguments(takeFlags()); }

  Materials table;
};

using Strings = std::vector<std::string>;

TEST_F(SlicerMaterials, RendererReportsItsChoicesAndItsLibrary) {
  EXPECT_GE(knownMaterials().library.size(), 24);
  for (const qFenestraMaterial& one : knownMaterials().library)
    EXPECT_FALSE(one.name.isEmpty());
  EXPECT_EQ(cell<QComboBox>(0, material).itemText(0), "liver (automatic)");
  EXPECT_TRUE(cell<QComboBox>(0, material).toolTip().contains("by name"));
  EXPECT_EQ(cell<QComboBox>(1, material).itemText(0), "artery (automatic)");
  EXPECT_EQ(cell<QComboBox>(2, material).itemText(0), "Automatic");
  EXPECT_TRUE(cell<QComboBox>(2, material).toolTip().contains("by its own color"));
  EXPECT_EQ(cell<QComboBox>(0, material).count(), knownMaterials().library.size() + 1);
  EXPECT_EQ(shownColor(0), "#6a3932");
  EXPECT_EQ(shownColor(2), "#3366cc"); // the segment's own color
}

TEST_F(SlicerMaterials, SourceIsOneFlagWithoutChanges) {
  EXPECT_TRUE(arguments().empty()) << "defaults are not flags";
  for (const char* word : {"none", "library", "contrast"}) {
    choose(word);
    EXPECT_EQ(arguments(), (Strings{std::string("--materials=") + word}));
    EXPECT_EQ(widget().isEnabled(), word != std::string("none"));
  }
  choose("file");
  EXPECT_TRUE(arguments().empty()) << "no file yet";
  auto& file = *table.findChild<QLineEdit*>("MaterialsFile");
  EXPECT_FALSE(file.isHidden());
  file.setText("/data/my own.json");
  emit file.editingFinished();
  EXPECT_EQ(arguments(), (Strings{"--materials=/data/my own.json"}));
  EXPECT_EQ(shownColor(0), "...") << "the colors of a materials file are unknown";
  choose("hand");
  EXPECT_EQ(arguments(), (Strings{"--materials=/data/my own.json"}));
  choose("");
  EXPECT_TRUE(arguments().empty());
}

TEST_F(SlicerMaterials, OnlyChangesAreArguments) {
  int changes = 0;
  QObject::connect(&table, &Materials::changed, [&changes] { ++changes; });
  setClip(1, false);
  EXPECT_EQ(changes, 1);
  EXPECT_EQ(chosen(), "hand");
  EXPECT_EQ(arguments(), (Strings{"--material=" + awkward + ": clip=no", "--materials=library"}));
  choose("library");
  EXPECT_EQ(arguments(), (Strings{"--materials=library"}));
  setMaterial(0, "spleen");
  EXPECT_EQ(chosen(), "hand");
  pickColor(0, "#ABCDEF");
  EXPECT_EQ(arguments(), (Strings{"--material=Segment_1: color=#abcdef, material=spleen",
                                  "--materials=library"}));
  EXPECT_EQ(shownColor(0), "#abcdef");
  setMaterial(0, "vein");
  const Strings vein = {"--material=Segment_1: material=vein", "--materials=library"};
  EXPECT_EQ(shownColor(0), "#605b78") << "a new material replaces the color";
  EXPECT_EQ(arguments(), vein);
  setClip(0, false);
  setClip(0, true);
  EXPECT_EQ(arguments(), vein);
  EXPECT_FALSE(cell<QToolButton>(1, reset).isEnabled());
  cell<QToolButton>(0, reset).click();
  EXPECT_EQ(arguments(), (Strings{"--materials=library"}));
  EXPECT_EQ(shownColor(0), "#6a3932");
}

/// Texts of a scene are not interpreted as HTML, and invalid colors are ignored.
TEST_F(SlicerMaterials, TextsOfASceneAreEscaped) {
  qFenestraMaterials hostile = knownMaterials();
  hostile.bySegment["Segment_1"].why = "<img src='file:///etc/passwd'>";
  table.setKnownMaterials(hostile);
  EXPECT_TRUE(cell<QComboBox>(0, material).toolTip().contains("&lt;img"));
  table.show({{"materials", "contrast"}, {"material", "Segment_1: color=<b>red</b>"}});
  EXPECT_EQ(shownColor(0), "#6a3932");
  EXPECT_FALSE(cell<QToolButton>(0, color).toolTip().contains("<b>"));
}

TEST_F(SlicerMaterials, UnknownSegmentKeepsTheVolumesColors) {
  qFenestraMaterials palette = knownMaterials();
  palette.bySegment["Segment_3"].why = "by palette";
  table.setKnownMaterials(palette);
  choose("library");
  EXPECT_EQ(shownColor(2), "#3366cc");
  for (const char* word : {"contrast", "none"}) {
    choose(word);
    EXPECT_EQ(shownColor(2), "...") << word;
  }
}

TEST_F(SlicerMaterials, ClipFollowsTheAutomaticChoice) {
  qFenestraMaterials unclipped = knownMaterials();
  unclipped.bySegment["Segment_1"].isClipped = false;
  table.setKnownMaterials(unclipped);
  EXPECT_FALSE(isClipped(0));
  setClip(0, true);
  EXPECT_EQ(arguments(), (Strings{"--material=Segment_1: clip=yes", "--materials=library"}));
  setClip(0, false);
  EXPECT_EQ(arguments(), (Strings{"--materials=library"}));
}

TEST_F(SlicerMaterials, CancelledDialogChangesNothing) {
  QTimer::singleShot(0,
                     [] { qobject_cast<QDialog*>(QApplication::activeModalWidget())->reject(); });
  cell<QToolButton>(0, color).click();
  EXPECT_TRUE(arguments().empty());
}

TEST_F(SlicerMaterials, RowsFollowTheSegments) {
  setMaterial(0, "spleen");
  setClip(1, false);
  auto all = makeSegments();
  all[1].name = "<b>Aorta</b>";
  table.list(toPanelSegments(all));
  EXPECT_EQ(text(1), "<b>Aorta</b>");
  EXPECT_FALSE(isClipped(1));
  const Strings both = arguments();
  all.erase(all.begin());
  table.list(toPanelSegments(all)); // "Liver" is removed
  EXPECT_EQ(widget().rowCount(), 2);
  EXPECT_EQ(text(0), "<b>Aorta</b>");
  EXPECT_FALSE(isClipped(0));
  EXPECT_EQ(arguments(), (Strings{"--material=" + awkward + ": clip=no", "--materials=library"}));
  table.list(toPanelSegments(makeSegments())); // restored, as by Undo
  EXPECT_EQ(arguments(), both);
  table.list({});
  EXPECT_FALSE(table.isEnabled());
  EXPECT_TRUE(arguments().empty()) << "the renderer rejects materials without segments";
}

TEST_F(SlicerMaterials, ShownFlagsAreWrittenUnchanged) {
  const std::string own = "Segment_1: color=#abcdef, density=2, priority=20";
  const std::string other = awkward + ": clip=no, material=vein";
  for (const Flags& flags : std::vector<Flags>{
           {},
           {{"materials", "none"}},
           {{"materials", "library"}},
           {{"materials", "/data/mine.json"}},
           {{"materials", "contrast"}, {"material", SlicerExport::joinList({own})}},
           {{"materials", "/data/mine.json"}, {"material", SlicerExport::joinList({other})}},
           {{"materials", "library"}, {"material", SlicerExport::joinList({own, other})}},
           {{"materials", "contrast"}, {"material", "Segment_3: material=of a file"}},
           {{"material", "Segment_3: clip=no"}}}) { // without `materials`: left to the user
    table.show(flags);
    EXPECT_EQ(takeFlags(), flags);
    EXPECT_EQ(chosen() == "hand", flags.count("material") > 0);
  }
  table.show({{"materials", "contrast"}, {"material", "Segment_3: material=of a file"}});
  EXPECT_EQ(cell<QComboBox>(2, material).currentData().toString(), "of a file");
  table.show({{"materials", "auto"}});
  EXPECT_EQ(arguments(), (Strings{"--materials=contrast"})) << "the former name";
}

TEST_F(SlicerMaterials, FlagsMayBeShownBeforeTheSegments) {
  const Flags flags = {{"materials", "library"},
                       {"material", SlicerExport::joinList({awkward + ": clip=no"})}};
  Materials early;
  early.show(flags);
  early.show({}); // nothing is passed without segments
  early.list(toPanelSegments(makeSegments()));
  Flags written;
  early.take(written);
  EXPECT_EQ(written, flags);
}

TEST_F(SlicerMaterials, ChangesByScriptsMaySelectByName) {
  table.show({{"materials", "library"},
              {"material", SlicerExport::joinList(
                               {"Liver: clip=no", "Gone: clip=no", "Segment_1: color=#00ff00"})}});
  EXPECT_FALSE(isClipped(0));
  EXPECT_EQ(arguments(),
            (Strings{"--material=Segment_1: clip=no, color=#00ff00", "--materials=library"}));
}

/// Scene with the segments side by side, as the extension writes it for the renderer.
class SlicerMaterialsImage : public SlicerMaterials {
protected:
  SlicerMaterialsImage() {
    SlicerExport::Contents contents;
    contents.volume.type = "int16";
    contents.volume.size = {9, 9, 9};
    const auto values = std::make_shared<std::vector<std::int16_t>>(729);
    std::iota(values->begin(), values->end(), std::int16_t(0));
    contents.volume.data = {values, values->data()};
    SlicerExport::Layer layer;
    layer.labels.type = "uint8";
    layer.labels.size = {9, 9, 9};
    const auto labels = std::make_shared<std::vector<std::uint8_t>>(729);
    for (std::size_t i = 0; i < labels->size(); ++i)
      (*labels)[i] = static_cast<std::uint8_t>(1 + i % 9 / 3);
    layer.labels.data = {labels, labels->data()};
    contents.segmentation.layers = {layer};
    contents.segmentation.segments = makeSegments();
    scene = SlicerExport::Writer(folder.path()).write(contents);
  }

  /// Image with the table's arguments, rendered by the queue as in the panel.
  std::string renderByPanel() const {
    QStringList all = {QString::fromStdString(scene.string()), "--size=24x24", "--samples=4",
                       "--output=panel.nrrd"};
    for (const std::string& argument : arguments())
      all << QString::fromStdString(argument);
    qFenestraQueue queue(program);
    std::vector<qFenestraOutcome> ended;
    QObject::connect(&queue, &qFenestraQueue::ended,
                     [&](int, const qFenestraOutcome& outcome) { ended.push_back(outcome); });
    queue.add({1, all, QString::fromStdString(folder.path().string())});
    EXPECT_TRUE(waitFor([&] { return !ended.empty(); }));
    for (const qFenestraOutcome& one : ended)
      EXPECT_EQ(one.kind, qFenestraOutcome::Kind::done) << one.details.toStdString();
    return readBytes(folder / "panel.nrrd");
  }
  /// Image with arguments as typed into a shell.
  std::string renderByCommand(const std::string& typed) const {
    const std::string command = "cd '" + folder.path().string() + "' && '" + program.toStdString() +
                                "' '" + scene.string() +
                                "' --size 24x24 --samples 4 --output hand.nrrd --progress none " +
                                typed + " >/dev/null";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    return readBytes(folder / "hand.nrrd");
  }

  TemporaryFolder folder;
  std::filesystem::path scene;
};

TEST_F(SlicerMaterialsImage, EqualsThatOfTheCommandLineBitForBit) {
  const std::string none = renderByPanel();
  EXPECT_TRUE(none == renderByCommand("")) << "without options";
  choose("library");
  const std::string library = renderByPanel();
  EXPECT_TRUE(library == renderByCommand("--materials library"));
  EXPECT_TRUE(library != none);
  pickColor(0, "#22cc44");
  setMaterial(1, "vein");
  pickColor(1, "#4466ff");
  setMaterial(2, "muscle");
  const std::string own = renderByPanel();
  EXPECT_TRUE(own ==
              renderByCommand(
                  R"(--materials library --material 'Segment_1: color=#22cc44' )"
                  R"(--material "a, \"b\": c=d; \$HOME 'e' \\, é: material=vein, color=#4466ff" )"
                  R"(--material "Thing: material=muscle")"));
  EXPECT_TRUE(own != library);
  for (int row = 0; row < 3; ++row)
    cell<QToolButton>(row, reset).click();
  EXPECT_TRUE(renderByPanel() == library);
}

/// The extension's scene contains the segments' colors, which unknown segments use.
TEST_F(SlicerMaterialsImage, UnknownSegmentHasItsOwnColor) {
  choose("library");
  EXPECT_TRUE(renderByPanel() ==
              renderByCommand("--materials library --material 'Segment_3: color=#3366cc'"));
}

TEST_F(SlicerMaterialsImage, PreviewAcceptsTheSameFlags) {
  setMaterial(0, "spleen");
  setMaterial(1, "vein");
  qFenestraPreview preview;
  std::vector<qFenestraPreviewImage> images;
  QStringList refused;
  QObject::connect(&preview, &qFenestraPreview::refreshed,
                   [&](const qFenestraPreviewImage& image) { images.push_back(image); });
  QObject::connect(&preview, &qFenestraPreview::refused,
                   [&](const QString& message) { refused << message; });
  const auto receiveImage = [&] {
    images.clear();
    const auto hasLast = [&] { // of the last change
      return !images.empty() && images.back().isCurrent && images.back().frame->isLast;
    };
    EXPECT_TRUE(waitFor([&] { return !refused.isEmpty() || hasLast(); }));
    EXPECT_TRUE(refused.isEmpty()) << refused.join('\n').toStdString();
    return hasLast() ? images.back().frame->display : std::vector<std::uint8_t>();
  };
  QStringList all = {QString::fromStdString(scene.string()), "--size=24x24", "--samples=2"};
  const QStringList bare = all;
  for (const std::string& argument : arguments())
    all << QString::fromStdString(argument);
  const QString path = QString::fromStdString(folder.path().string());
  preview.start(program, all, path);
  const std::vector<std::uint8_t> first = receiveImage();
  preview.start(program, bare, path);
  EXPECT_TRUE(receiveImage() != first);
  preview.change(qFenestraPreview::toJson(takeFlags()));
  EXPECT_TRUE(receiveImage() == first);
}

TEST_F(SlicerMaterials, ResetRemovesAllChanges) {
  setMaterial(0, "spleen");
  table.reset();
  EXPECT_TRUE(arguments().empty());
  choose("hand");
  EXPECT_EQ(arguments(), (Strings{"--materials=library"}));
}

} // namespace
} // namespace fenestra::core
