// Checks of flags in scenes from untrusted sources, and their conversion to arguments.

#include "FenestraFlags.h"
#include "FenestraMaterials.h"

#include <QMap>
#include <QProcess>
#include <QXmlStreamReader>
#include <gtest/gtest.h>

namespace fenestra::core {
namespace {

using SlicerExport::checkFlag;
using SlicerExport::FlagKind;
using SlicerExport::Verdict;

struct Case {
  const char* name;
  std::string value;
};

TEST(SlicerFlags, ValuesThatTheRendererAcceptsAreValid) {
  for (const auto& [name, value] :
       std::vector<Case>{{"focus", "Segment_1,a\\,b, <\xc3\xa9>"},
                         {"margin", "1,-0.5,3e-2"},
                         {"clip", "cutaway"},
                         {"labelsmoothing", "0.6"},
                         {"soft", "auto"},
                         {"contextsaturation", "auto"},
                         {"exposure", "-1.25"},
                         {"tone", "photographic"},
                         {"sampling", "independent"},
                         {"background", "gradient"},
                         {"controlpoints", "50"},
                         {"plane", "1,2,3,0,0,-1"},
                         {"position", "-1.5,2,3"},
                         {"environment", "1,1,0.5"},
                         {"preset", "knee-cartilage"},
                         {"transfer", "CT-Coronary-Arteries-2"},
                         {"transfer", R"({"points": [[0, 1]]})"},
                         {"lights", R"({"lights": [{"type": "area"}]})"},
                         {"background", "transparent"},
                         {"background", "0,0,0"},
                         {"materials", "library"},
                         {"material", "Liver: color=#963e2e\\, clip=no,a/b.c: clip=no"},
                         {"denoise", "off"},
                         {"noisetarget", "filtered"},
                         {"size", "512x384"},
                         {"seed", "18446744073709551615"},
                         {"degrees", "-90.5"}})
    EXPECT_EQ(checkFlag(name, value), Verdict::valid) << name << ": " << value;
}

TEST(SlicerFlags, MalformedValuesAreInvalid) {
  for (const auto& [name, value] : std::vector<Case>{{"frames", "x"},
                                                     {"frames", ""},
                                                     {"frames", "-3"},
                                                     {"frames", "3.5"},
                                                     {"frames", "999999999999999999999"},
                                                     {"degrees", "1e999"},
                                                     {"degrees", "nan"},
                                                     {"degrees", "90 "
                                                                 "--output"},
                                                     {"margin", "1,,2"},
                                                     {"margin", "1,"},
                                                     {"noise", "0.05,1"},
                                                     {"soft", "automatic"},
                                                     {"soft", "auto,1"},
                                                     {"soft", "1 auto"},
                                                     {"soft", "nan"},
                                                     {"labelsmoothing", "auto "},
                                                     {"offset", "auto"},
                                                     {"exposure", "bright"},
                                                     {"clip", "--output=x"},
                                                     {"clip", "surface\n"},
                                                     {"size", "512"},
                                                     {"size", "x"},
                                                     {"size", "1x2x3"},
                                                     {"background", "file.exr"},
                                                     {"focus", std::string("a\0b", 3)},
                                                     {"material", std::string("a\0b", 3)},
                                                     {"lights", std::string(200000, 'a')},
                                                     {"output", "a.png"},
                                                     {"stats", "a.json"}})
    EXPECT_EQ(checkFlag(name, value), Verdict::invalid) << name << ": " << value.substr(0, 40);
}

TEST(SlicerFlags, FileNamesAreDetectedEvenInsideJson) {
  for (const auto& [name, value] : std::vector<Case>{
           {"transfer", "/etc/passwd"},
           {"transfer", "mine.vp"},
           {"transfer", "..\\secret"},
           {"preset", "\\\\server\\share"},
           {"preset", "~root"},
           {"environment", "sky.exr"},
           {"materials", "mine.json"},
           {"lights", "C:lights"},
           {"lights", R"({"lights": [{"type": "environment", "file": "/etc/passwd"}]})"},
           {"lights", R"({"lights": [{"type": "environment", "\u0066ile": "/etc/passwd"}]})"}})
    EXPECT_EQ(checkFlag(name, value), Verdict::file) << name << ": " << value;
}

struct Option {
  QString text;        ///< description
  QStringList choices; ///< all values of an option with fixed choices
};

/// Options by name, from the renderer's description for Slicer.
QMap<QString, Option> parseOptions(const QString& description) {
  QMap<QString, Option> all;
  QXmlStreamReader xml(description);
  QString name;
  while (!xml.atEnd()) {
    xml.readNext();
    if (!xml.isStartElement())
      continue;
    if (xml.name() == QLatin1String("parameters"))
      name.clear(); // a group of options follows
    else if (xml.name() == QLatin1String("name"))
      name = xml.readElementText();
    else if (xml.name() == QLatin1String("description") && !name.isEmpty())
      all[name].text = xml.readElementText();
    else if (xml.name() == QLatin1String("element"))
      all[name].choices << xml.readElementText();
  }
  return all;
}

/// Reference: the renderer's own description of its options.
TEST(SlicerFlags, KindsMatchTheRenderersOptions) {
  QProcess child;
  child.start(FENESTRA_EXECUTABLE, {"--xml"});
  ASSERT_TRUE(child.waitForFinished());
  const QString description = QString::fromUtf8(child.readAllStandardOutput());
  const auto known = parseOptions(description);
  for (const SlicerExport::Flag& flag : SlicerExport::flags()) {
    if (flag.turntableOnly)
      continue;
    const QString name = QString::fromStdString(flag.name);
    ASSERT_TRUE(known.contains(name)) << flag.name;
    const bool hasWords = !known[name].choices.isEmpty();
    EXPECT_EQ(flag.kind == FlagKind::word, hasWords) << flag.name;
    const bool canBeAuto = !hasWords && flag.kind != FlagKind::resource; // may be named "auto"
    const bool acceptsAuto =
        flag.kind == FlagKind::numberOrAuto || flag.kind == FlagKind::wordOrNumbers;
    EXPECT_TRUE(acceptsAuto || !canBeAuto || !known[name].text.contains("auto:")) << flag.name;
    EXPECT_TRUE(flag.kind != FlagKind::numberOrAuto || known[name].text.contains("auto:"))
        << flag.name;
    EXPECT_TRUE(!SlicerExport::isRepeatable(flag.name) ||
                known[name].text.contains("may be repeated"))
        << flag.name;
    for (const QString& word : known[name].choices)
      EXPECT_EQ(checkFlag(flag.name, word.toStdString()), Verdict::valid) << flag.name;
  }
}

TEST(SlicerFlags, JoinedListsAreSplitAgain) {
  const std::vector<std::string> texts = {"Liver: color=#963e2e, clip=no", "a\\b, \"c\": clip=no",
                                          "d"};
  const std::string value = SlicerExport::joinList(texts);
  EXPECT_EQ(SlicerExport::splitList(value), texts);
  EXPECT_TRUE(SlicerExport::splitList("").empty());
  EXPECT_EQ(SlicerExport::toArguments({{"focus", "a,b"}, {"material", value}, {"offset", "-1"}}),
            (std::vector<std::string>{"--focus=a,b", "--material=" + texts[0],
                                      "--material=" + texts[1], "--material=d", "--offset=-1"}));
}

/// The renderer would reject a change to a missing segment, and render no image.
TEST(SlicerFlags, ChangesToMissingSegmentsAreRemoved) {
  using Flags = std::map<std::string, std::string>;
  const std::vector<SlicerExport::Segment> segments = {{"S,1", "Liver", 1}, {"S2", "Aorta", 7}};
  const auto change = [](const char* selector) { return std::string(selector) + ": clip=no"; };
  const std::string value = SlicerExport::joinList(
      {change("S,1"), change("gone"), change("Aorta"), change("7"), change("8")});
  EXPECT_EQ(
      SlicerExport::filterMaterialFlags(segments, {{"materials", "contrast"}, {"material", value}}),
      (Flags{{"materials", "contrast"},
             {"material", SlicerExport::joinList({change("S,1"), change("Aorta"), change("7")})}}));
  EXPECT_EQ(SlicerExport::filterMaterialFlags({}, {{"materials", "contrast"}, {"material", value}}),
            Flags());
  EXPECT_EQ(SlicerExport::filterMaterialFlags({}, {{"view", "left"}}), (Flags{{"view", "left"}}));
}

} // namespace
} // namespace fenestra::core
