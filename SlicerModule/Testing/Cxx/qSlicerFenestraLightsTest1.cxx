// Light rigs with scaled lights.

#include "FenestraTesting.h"

#include "qSlicerFenestraLights.h"

#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>

int qSlicerFenestraLightsTest1(int, char*[]) {
  using namespace qSlicerFenestraLights;
  for (const char* rig : {"cinema", "studio", "headlight", "soft"}) {
    CHECK_STD_STRING(flag(rig, unchanged).toStdString(), std::string(rig));
    const QJsonArray lights = QJsonDocument::fromJson(flag(rig, {1.0, 1.0, 1.0, 2.0}).toUtf8())
                                  .object()["lights"]
                                  .toArray();
    CHECK_BOOL(lights.isEmpty(), false);
    CHECK_STD_STRING(lights.last().toObject()["type"].toString().toStdString(),
                     std::string(rig) == "cinema" ? "sky" : "environment");
  }
  const auto first = [](const Strengths& strengths, int light) {
    const QJsonObject rig = QJsonDocument::fromJson(flag("studio", strengths).toUtf8()).object();
    return rig["lights"].toArray()[light].toObject()["radiance"].toArray()[0].toDouble();
  };
  CHECK_DOUBLE(first({2.0, 1.0, 1.0, 1.0}, 0), 2.0 * first({1.0, 0.5, 1.0, 1.0}, 0));
  CHECK_DOUBLE(first({1.0, 0.5, 1.0, 1.0}, 1), 0.5 * first({2.0, 1.0, 1.0, 1.0}, 1));
  CHECK_DOUBLE(first({1.0, 1.0, 0.0, 1.0}, 2), 0.0);
  const auto cinema = [](const Strengths& strengths, int light, const char* key) {
    const QJsonObject rig = QJsonDocument::fromJson(flag("cinema", strengths).toUtf8()).object();
    return rig["lights"].toArray()[light].toObject()[key];
  };
  const Strengths half = {0.5, 1.0, 1.0, 0.5};
  CHECK_DOUBLE(cinema(half, 0, "radiance").toDouble(),
               0.25 * cinema({2.0, 1.0, 1.0, 1.0}, 0, "radiance").toDouble());
  CHECK_DOUBLE(cinema(half, 3, "top").toArray()[2].toDouble(),
               0.25 * cinema({1.0, 1.0, 1.0, 2.0}, 3, "top").toArray()[2].toDouble());
  CHECK_BOOL(cinema(half, 0, "color").toString().startsWith("#"), true);
  return EXIT_SUCCESS;
}
