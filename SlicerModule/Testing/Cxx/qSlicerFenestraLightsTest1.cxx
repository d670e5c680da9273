// Light rigs with scaled lights.

#include "FenestraTesting.h"

#include "qSlicerFenestraLights.h"

#include <QJsonDocument>
#include <QJsonObject>

#include <map>

namespace {

using namespace qSlicerFenestraLights;
using Has = std::array<bool, 4>;

QJsonArray parseLights(const QString& rig) {
  return QJsonDocument::fromJson(rig.toUtf8()).object()["lights"].toArray();
}

int checkRigs() {
  for (const std::string rig :
       {"theatre-wet", "theatre", "cinema", "studio", "headlight", "soft", "amber"}) {
    CHECK_STD_STRING(makeFlag(rig.c_str(), unchanged).toStdString(), rig);
    const QJsonArray lights = parseLights(makeFlag(rig.c_str(), {1.0, 1.0, 1.0, 2.0}));
    CHECK_BOOL(lights.isEmpty(), false);
    CHECK_STD_STRING(lights.last().toObject()["type"].toString().toStdString(),
                     rig == "cinema" || rig.rfind("theatre", 0) == 0 ? "sky" : "environment");
  }
  const std::map<QString, Has> expected = {
      {"cinema", {true, true, true, true}},  {"theatre-wet", {true, true, true, true}},
      {"amber", {true, true, false, true}},  {"headlight", {true, false, false, true}},
      {"soft", {false, false, false, true}}, {"nothing", {false, false, false, false}}};
  for (const auto& [rig, has] : expected)
    CHECK_BOOL(findLights(rig) == has, true);
  const Strengths others = {0.5, 2.0, 0.0, 1.0}; // of lights that these rigs lack
  CHECK_STD_STRING(makeFlag("soft", others).toStdString(), "soft");
  CHECK_STD_STRING(makeFlag("my.json", others).toStdString(), "my.json");
  return EXIT_SUCCESS;
}

int checkStrengths() {
  const auto redOfStudio = [](const Strengths& strengths, int light) {
    return parseLights(makeFlag("studio", strengths))[light]
        .toObject()["radiance"]
        .toArray()[0]
        .toDouble();
  };
  CHECK_DOUBLE(redOfStudio({2.0, 1.0, 1.0, 1.0}, 0), 2.0 * redOfStudio({1.0, 0.5, 1.0, 1.0}, 0));
  CHECK_DOUBLE(redOfStudio({1.0, 0.5, 1.0, 1.0}, 1), 0.5 * redOfStudio({2.0, 1.0, 1.0, 1.0}, 1));
  CHECK_DOUBLE(redOfStudio({1.0, 1.0, 0.0, 1.0}, 2), 0.0);
  const auto fieldOfCinema = [](const Strengths& strengths, int light, const char* key) {
    return parseLights(makeFlag("cinema", strengths))[light].toObject().value(key);
  };
  const Strengths half = {0.5, 1.0, 1.0, 0.5};
  CHECK_DOUBLE(fieldOfCinema(half, 0, "radiance").toDouble(),
               0.25 * fieldOfCinema({2.0, 1.0, 1.0, 1.0}, 0, "radiance").toDouble());
  CHECK_DOUBLE(fieldOfCinema(half, 3, "top").toArray()[2].toDouble(),
               0.25 * fieldOfCinema({1.0, 1.0, 1.0, 2.0}, 3, "top").toArray()[2].toDouble());
  CHECK_BOOL(fieldOfCinema(half, 0, "color").toString().startsWith("#"), true);
  return EXIT_SUCCESS;
}

/// A rig unlike the renderer's own: a sphere is the key light, and a rim light comes first. Lights
/// in world space, and lights beyond the four strengths, are unchanged.
int checkOthers() {
  const QJsonArray lights = parseLights(R"({"lights": [
    {"type": "disk", "frame": "camera", "center": [0, 1, -2], "radiance": 1},
    {"type": "sphere", "frame": "focus", "center": [0, 9, 9], "radiance": [1, 1, 1]},
    {"type": "rectangle", "center": [0, 500, 0], "radiance": 1},
    {"type": "directional", "direction": [0, -1, 0], "irradiance": [1, 1, 1]},
    {"type": "sphere", "frame": "camera", "center": [1, 1, 2], "color": "#ffeedd", "radiance": 1},
    {"type": "rectangle", "frame": "camera", "center": [-1, 1, 2], "radiance": 1},
    {"type": "rectangle", "frame": "camera", "center": [0, 3, 2], "radiance": 1},
    {"type": "glow", "radiance": 1},
    {"type": "sky", "top": [1, 1, 1], "middle": [1, 1, 1], "bottom": [1, 1, 1]}]})");
  const QJsonArray all = scaleLights(lights, {2.0, 3.0, 5.0, 7.0});
  CHECK_INT(all.size(), lights.size());
  const double expected[] = {5.0, 1.0, 1.0, 1.0, 2.0, 3.0, 1.0, 1.0};
  for (int i = 0; i < 8; ++i) {
    const QJsonValue radiance = all[i].toObject().value("radiance");
    if (expected[i] == 1.0) {
      CHECK_BOOL(all[i] == lights[i], true);
    } else {
      CHECK_DOUBLE(radiance.toDouble(), expected[i]);
    }
  }
  CHECK_DOUBLE(all[8].toObject()["bottom"].toArray()[1].toDouble(), 7.0);
  return EXIT_SUCCESS;
}

} // namespace

int qSlicerFenestraLightsTest1(int, char*[]) {
  CHECK_EXIT_SUCCESS(checkRigs());
  CHECK_EXIT_SUCCESS(checkStrengths());
  CHECK_EXIT_SUCCESS(checkOthers());
  return EXIT_SUCCESS;
}
