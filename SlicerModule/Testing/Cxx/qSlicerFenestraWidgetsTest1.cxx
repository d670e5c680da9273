// Widgets for appearance and clipping without a scene: flags that they show and write.

#include "FenestraTesting.h"

#include "qSlicerFenestraClipping.h"
#include "qSlicerFenestraLights.h"
#include "qSlicerFenestraLook.h"
#include "qSlicerFenestraMargins.h"
#include "qSlicerFenestraPreviewLabel.h"
#include "qSlicerFenestraQuality.h"
#include "qSlicerFenestraSettings.h"

#include <ctkCollapsibleGroupBox.h>
#include <ctkSliderWidget.h>

#include <QApplication>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QKeyEvent>
#include <QVBoxLayout>

namespace {

using Flags = std::map<std::string, std::string>;
using Look = qSlicerFenestraLook;
using Clipping = qSlicerFenestraClipping;

QComboBox& box(const QWidget& widget, const char* name) {
  return *widget.findChild<QComboBox*>(name);
}

void choose(const QWidget& widget, const char* name, const QString& data) {
  box(widget, name).setCurrentIndex(box(widget, name).findData(data));
}

QDoubleSpinBox& number(const QWidget& widget, const char* name) {
  return *widget.findChild<QDoubleSpinBox*>(name);
}

void press(QWidget& widget, int key, const QString& text = {}) {
  QKeyEvent event(QEvent::KeyPress, key, Qt::NoModifier, text);
  QApplication::sendEvent(&widget, &event);
}

/// Nonempty flags that the widget writes.
Flags takeFlags(const Look& look) {
  Flags flags, given;
  look.take(flags);
  for (const auto& [name, value] : flags)
    if (!value.empty())
      given[name] = value;
  return given;
}

int checkLookDefaults() {
  Look look;
  const Flags dark = {{"background", "dark"}};
  CHECK_BOOL(takeFlags(look) == dark, true);
  look.show(dark, {}, false);
  CHECK_BOOL(takeFlags(look) == dark, true);
  for (const char* preset :
       {"ct-anatomy", "ct-contrast", "ct-lung", "ct-bone", "ct-skin", "ct-soft", "ct-skeleton",
        "mr-anatomy", "mr-knee", "us-fetal", "pet"}) {
    choose(look, "TransferBox", preset);
    CHECK_STD_STRING(takeFlags(look)["transfer"], std::string(preset));
  }
  for (const char* rig :
       {"theatre-wet", "theatre", "cinema", "studio", "headlight", "soft", "amber"}) {
    choose(look, "RigBox", rig);
    CHECK_STD_STRING(takeFlags(look)["lights"], std::string(rig));
  }
  look.resetToPreset();
  CHECK_BOOL(takeFlags(look) == dark, true);
  choose(look, "ToneBox", "photographic");
  CHECK_STD_STRING(takeFlags(look)["tone"], "photographic");
  number(look, "ExposureBox").setValue(-0.75);
  CHECK_STD_STRING(takeFlags(look)["exposure"], "-0.75");
  look.show({{"exposure", "-0.75"}, {"tone", "photographic"}, {"background", "0,0,0"}}, {}, false);
  choose(look, "ToneBox", "film");
  number(look, "ExposureBox").setValue(0.0);
  CHECK_BOOL(takeFlags(look) == Flags({{"background", "0,0,0"}}), true);
  return EXIT_SUCCESS;
}

/// Flag values that the widgets cannot represent stay until the user chooses another.
int checkLookKeepsUnknownValues() {
  Look look;
  const Flags flags = {{"transfer", "CT-AAA"},
                       {"lights", R"({"lights": [{"type": "environment", "radiance": 1}]})"},
                       {"background", "0.3,0.2,0.1"},
                       {"exposure", "-9.125"},
                       {"tone", "film"}};
  look.show(flags, "cinema 50 100 100 100", false); // this rig does not produce these lights
  Flags taken = flags;
  look.take(taken);
  CHECK_BOOL(taken == flags, true);
  CHECK_DOUBLE(look.findChild<ctkSliderWidget*>("Strength0")->value(), 100.0);
  choose(look, "TransferBox", "ct-bone");
  look.take(taken);
  CHECK_STD_STRING(taken["transfer"], "ct-bone");
  CHECK_STD_STRING(taken["exposure"], "-9.125");
  look.show({{"transfer", "MR-Default"}}, {}, false); // replaces the item added before
  CHECK_INT(box(look, "TransferBox").findData("CT-AAA"), -1);
  return EXIT_SUCCESS;
}

int checkRigs() {
  Look look;
  const auto strength = [&look](int i) {
    return look.findChild<ctkSliderWidget*>(QString("Strength%1").arg(i));
  };
  const QWidget& hint = *look.findChild<QWidget*>("LightsHint");
  for (int i = 0; i < 4; ++i) {
    look.show({}, {}, false);
    CHECK_BOOL(strength(i)->isEnabled(), false); // by default
    CHECK_BOOL(hint.isHidden(), false);
    const QString reason = strength(i)->toolTip();
    look.show({{"lights", "cinema"}}, {}, false);
    CHECK_BOOL(strength(i)->isEnabled(), true);
    CHECK_BOOL(hint.isHidden(), true);
    CHECK_BOOL(strength(i)->toolTip() == reason, false);
    look.show({{"lights", "soft"}}, {}, false);
    CHECK_BOOL(strength(i)->isEnabled(), i == 3);
  }
  choose(look, "RigBox", "studio");
  strength(0)->setValue(50.0);
  Flags flags;
  const QString stored = look.take(flags);
  CHECK_STD_STRING(stored.toStdString(), "studio 50 100 100 100");
  CHECK_BOOL(flags["lights"].front() == '{', true);
  Look again;
  again.show(flags, stored, false);
  CHECK_STD_STRING(box(again, "RigBox").currentData().toString().toStdString(), "studio");
  CHECK_DOUBLE(again.findChild<ctkSliderWidget*>("Strength0")->value(), 50.0);
  const Flags before = flags;
  CHECK_STD_STRING(again.take(flags).toStdString(), stored.toStdString());
  CHECK_BOOL(flags == before, true);
  return EXIT_SUCCESS;
}

/// Anatomies, tissue colors and rigs have icons, except defaults and anatomies without data for
/// one. The boxes are not higher than others.
int checkIcons() {
  const qSlicerFenestraSettings panel;
  const int height = box(panel, "ViewBox").sizeHint().height();
  const std::map<const char*, QStringList> without = {
      {"PresetBox", {"", "auto", "heart", "brain-tumor"}}, {"TransferBox", {""}}, {"RigBox", {""}}};
  for (const auto& [name, data] : without) {
    const QComboBox& choices = box(panel, name);
    CHECK_INT(choices.sizeHint().height(), height);
    for (int i = 0; i < choices.count(); ++i)
      CHECK_BOOL(choices.itemIcon(i).isNull(), data.contains(choices.itemData(i).toString()));
  }
  return EXIT_SUCCESS;
}

/// The preview is as wide as the panel and has the image's aspect ratio, but is not higher than
/// wide. It is smaller where other widgets need the height.
int checkPreview() {
  QWidget panel;
  auto* preview = new qSlicerFenestraPreviewLabel;
  auto* rest = new QWidget;
  auto* layout = new QVBoxLayout(&panel);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  layout->addWidget(preview, 1);
  layout->addWidget(rest);
  layout->addStretch(0);
  panel.resize(512, 800);
  panel.show();
  preview->showText("Load a volume");
  CHECK_BOOL(preview->maximumHeight() < 100, true);
  QImage image(256, 192, QImage::Format_RGB32);
  image.fill(Qt::red);
  preview->showImage(image);
  QApplication::processEvents();
  CHECK_BOOL(preview->size() == QSize(512, 384), true);
  const QImage shown = preview->grab().toImage();
  for (const QPoint& corner : {QPoint(2, 2), QPoint(509, 381)})
    CHECK_BOOL(shown.pixelColor(corner) == QColor(Qt::red), true);
  preview->showImage(image.scaled(96, 256));
  QApplication::processEvents();
  CHECK_BOOL(preview->size() == QSize(512, 512), true);
  rest->setMinimumHeight(500);
  QApplication::processEvents();
  CHECK_INT(preview->height(), 300);
  rest->setMinimumHeight(2000);
  QApplication::processEvents();
  CHECK_INT(preview->height(), preview->sizeHint().height());
  return EXIT_SUCCESS;
}

/// A size "as the 3D view" follows the view's size, up to the limit of the boxes.
int checkViewSize() {
  const qSlicerFenestraQuality quality;
  Flags flags = {{"size", "512x512"}};
  const auto follow = [&](const char* viewSize, const QSize& view) {
    return quality.followView(flags, viewSize, view).toStdString();
  };
  CHECK_STD_STRING(follow("2 512x512", {700, 500}), "2 1400x1000");
  CHECK_STD_STRING(flags["size"], "1400x1000");
  CHECK_STD_STRING(follow("2 1400x1000", {}), "2 1400x1000"); // there is no view
  CHECK_STD_STRING(follow("4 1400x1000", {3840, 1920}), "4 8192x4096");
  CHECK_STD_STRING(flags["size"], "8192x4096");
  for (const char* fixed : {"", "2 512x512", "0 8192x4096", "-1 8192x4096", "x"}) {
    follow(fixed, {700, 500});
    CHECK_STD_STRING(flags["size"], "8192x4096");
  }
  return EXIT_SUCCESS;
}

/// Numbers that may be "auto" can be set by the keyboard alone.
int checkAutomatic() {
  Clipping clipping;
  auto* details = clipping.findChild<ctkCollapsibleGroupBox*>("ClipDetails");
  CHECK_BOOL(details->collapsed(), true);
  CHECK_BOOL(details->maximumHeight() > details->fontMetrics().height() + 8, true); // its title
  details->setCollapsed(false);                                                     // enables them
  const QList<qSlicerFenestraSegment> focus = {{"A", "A"}};
  const auto taken = [&clipping](const char* flag) {
    Flags flags;
    clipping.take(flags, {}, true, false);
    return flags[flag];
  };
  for (const char* flag : {"labelsmoothing", "soft", "contextsaturation"}) {
    clipping.show({}, Clipping::Plane::automatic, focus, false);
    QDoubleSpinBox& one = number(clipping, (std::string(flag) + "Box").c_str());
    CHECK_STD_STRING(one.text().toStdString(), "auto");
    CHECK_STD_STRING(taken(flag), "");
    press(one, Qt::Key_Up);
    CHECK_DOUBLE(one.value(), 0.0);
    CHECK_STD_STRING(taken(flag), "0");
    press(one, Qt::Key_Down);
    CHECK_STD_STRING(one.text().toStdString(), "auto");
    one.selectAll();
    for (const QChar sign : QString("-0.3")) // the minus sign is rejected
      press(one, 0, sign);
    CHECK_DOUBLE(one.value(), 0.3);
    press(one, Qt::Key_Down);
    CHECK_DOUBLE(one.value(), 0.0);
    press(one, Qt::Key_PageDown);
    CHECK_STD_STRING(taken(flag), "");
    clipping.show({{flag, "0.5"}}, Clipping::Plane::automatic, focus, false); // from an old scene
    CHECK_STD_STRING(taken(flag), "0.5");
    clipping.show({{flag, "auto"}}, Clipping::Plane::automatic, focus, false);
    CHECK_STD_STRING(one.text().toStdString(), "auto");
    CHECK_STD_STRING(taken(flag), "auto"); // overrides a preset
    clipping.reset();
    CHECK_STD_STRING(taken(flag), "");
  }
  return EXIT_SUCCESS;
}

} // namespace

int qSlicerFenestraWidgetsTest1(int argc, char* argv[]) {
  const QApplication application(argc, argv);
  CHECK_EXIT_SUCCESS(checkLookDefaults());
  CHECK_EXIT_SUCCESS(checkLookKeepsUnknownValues());
  CHECK_EXIT_SUCCESS(checkRigs());
  CHECK_EXIT_SUCCESS(checkIcons());
  CHECK_EXIT_SUCCESS(checkPreview());
  CHECK_EXIT_SUCCESS(checkViewSize());
  CHECK_EXIT_SUCCESS(checkAutomatic());
  return EXIT_SUCCESS;
}
