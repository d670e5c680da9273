#include "qSlicerFenestraLights.h"

#include <QFile>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>

QString qSlicerFenestraLights::flag(const QString& rig, const Strengths& strengths) {
  if (strengths == unchanged)
    return rig;
  QFile file(":/Lights/" + rig + ".json");
  if (!file.open(QIODevice::ReadOnly))
    return rig;
  QJsonArray lights = QJsonDocument::fromJson(file.readAll()).object()["lights"].toArray();
  std::size_t area = 0;
  constexpr std::size_t environment = 3;
  for (int i = 0; i < lights.size(); ++i) {
    QJsonObject light = lights[i].toObject();
    const bool surrounds = light["type"] == "environment";
    const std::size_t which = surrounds ? environment : std::min(area++, environment - 1);
    QJsonArray radiance = light["radiance"].toArray();
    for (int c = 0; c < radiance.size(); ++c)
      radiance[c] = radiance[c].toDouble() * strengths[which];
    light["radiance"] = radiance;
    lights[i] = light;
  }
  const QJsonObject document = {{"lights", lights}};
  return QString::fromUtf8(QJsonDocument(document).toJson(QJsonDocument::Compact));
}
