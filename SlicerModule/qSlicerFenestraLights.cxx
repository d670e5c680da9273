#include "qSlicerFenestraLights.h"

#include <QFile>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>

namespace {

/// Radiance of a light, a number or a triple, times a factor.
QJsonValue scaled(const QJsonValue& radiance, double factor) {
  if (!radiance.isArray())
    return radiance.toDouble() * factor;
  QJsonArray triple;
  for (const QJsonValue& value : radiance.toArray())
    triple.append(value.toDouble() * factor);
  return triple;
}

} // namespace

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
    const bool surrounds = light["type"] == "environment" || light["type"] == "sky";
    const std::size_t which = surrounds ? environment : std::min(area++, environment - 1);
    for (const char* key : {"radiance", "top", "middle", "bottom"})
      if (light.contains(key))
        light[key] = scaled(light[key], strengths[which]);
    lights[i] = light;
  }
  const QJsonObject document = {{"lights", lights}};
  return QString::fromUtf8(QJsonDocument(document).toJson(QJsonDocument::Compact));
}
