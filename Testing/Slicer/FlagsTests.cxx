// Flags in a scene from an untrusted source: those that are accepted.

#include "FenestraFlags.h"
#include "qFenestraAbilities.h"

#include <QProcess>
#include <gtest/gtest.h>

namespace fenestra {
namespace {

using FenestraScene::FlagKind;
using FenestraScene::Verdict;
using FenestraScene::verdictOn;

struct Case {
  const char* name;
  std::string value;
};

TEST(SlicerFlags, ValuesThatTheRendererTakesAreGood) {
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
                         {"size", "512x384"},
                         {"seed", "18446744073709551615"},
                         {"degrees", "-90.5"}})
    EXPECT_EQ(verdictOn(name, value), Verdict::good) << name << ": " << value;
}

TEST(SlicerFlags, MalformedValuesAreRejected) {
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
                                                     {"lights", std::string(200000, 'a')},
                                                     {"output", "a.png"},
                                                     {"stats", "a.json"}})
    EXPECT_EQ(verdictOn(name, value), Verdict::bad) << name << ": " << value.substr(0, 40);
}

TEST(SlicerFlags, NamesOfFilesAreDetectedAlsoInsideTexts) {
  for (const auto& [name, value] : std::vector<Case>{
           {"transfer", "/etc/passwd"},
           {"transfer", "colours.vp"},
           {"transfer", "..\\secret"},
           {"preset", "\\\\server\\share"},
           {"preset", "~root"},
           {"environment", "sky.exr"},
           {"lights", "C:lights"},
           {"lights", R"({"lights": [{"type": "environment", "file": "/etc/passwd"}]})"},
           {"lights", R"({"lights": [{"type": "environment", "\u0066ile": "/etc/passwd"}]})"}})
    EXPECT_EQ(verdictOn(name, value), Verdict::file) << name << ": " << value;
}

/// Reference: the renderer's own description of its numbers and words.
TEST(SlicerFlags, KindsEqualThoseOfTheRenderer) {
  QProcess child;
  child.start(FENESTRA_EXECUTABLE, {"--xml"});
  ASSERT_TRUE(child.waitForFinished());
  const QString description = QString::fromUtf8(child.readAllStandardOutput());
  const auto known = qFenestraAbilities::flagsIn(description);
  for (const FenestraScene::Flag& flag : FenestraScene::flags()) {
    if (flag.ofTurntable)
      continue;
    const QString name = QString::fromStdString(flag.name);
    ASSERT_TRUE(known.contains(name)) << flag.name;
    const bool hasWords = !known[name].words.isEmpty();
    EXPECT_EQ(flag.kind == FlagKind::word, hasWords) << flag.name;
    EXPECT_EQ(flag.kind == FlagKind::automatic, !hasWords && known[name].text.contains("auto:"))
        << flag.name;
    for (const QString& word : known[name].words)
      EXPECT_EQ(verdictOn(flag.name, word.toStdString()), Verdict::good) << flag.name;
  }
}

} // namespace
} // namespace fenestra
