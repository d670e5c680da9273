#include "qSlicerFenestraLights.h"

#include <QFile>
#include <QJsonDocument>
#include <QJsonObject>

#include <algorithm>
#include <vector>

namespace {

enum Role : std::size_t { key, fill, rim, environment, none };

/// Role of each light.
std::vector<Role> assignRoles(const QJsonArray& lights) {
  std::vector<Role> roles;
  Role next = key; // role of the next light in front of the volume
  for (const QJsonValue& value : lights) {
    const QJsonObject light = value.toObject();
    const QString type = light["type"].toString();
    const bool isEnvironment = type == "environment" || type == "sky";
    const bool isPlaced = light["frame"] == "camera" && light.contains("center");
    if (isEnvironment || !isPlaced) {
      roles.push_back(isEnvironment ? environment : none);
    } else if (light["center"].toArray().at(2).toDouble() < 0.0) { // z is toward the viewer
      roles.push_back(rim);
    } else {
      roles.push_back(next);
      next = next == key ? fill : none;
    }
  }
  return roles;
}

/// Product of a radiance, a number or an RGB triple, and a factor.
QJsonValue scaleRadiance(const QJsonValue& radiance, double factor) {
  if (!radiance.isArray())
    return radiance.toDouble() * factor;
  QJsonArray triple;
  for (const QJsonValue& value : radiance.toArray())
    triple.append(value.toDouble() * factor);
  return triple;
}

/// Lights of a rig of the renderer; empty: unknown rig.
QJsonArray readRig(const QString& rig) {
  QFile file(":/Lights/" + rig + ".json");
  if (!file.open(QIODevice::ReadOnly))
    return {};
  return QJsonDocument::fromJson(file.readAll()).object()["lights"].toArray();
}

} // namespace

QJsonArray qSlicerFenestraLights::scaleLights(const QJsonArray& lights,
                                              const Strengths& strengths) {
  const std::vector<Role> roles = assignRoles(lights);
  QJsonArray all;
  for (int i = 0; i < lights.size(); ++i) {
    QJsonObject light = lights[i].toObject();
    const Role role = roles[static_cast<std::size_t>(i)];
    for (const char* name : {"radiance", "top", "middle", "bottom"})
      if (role != none && strengths[role] != 1.0 && light.contains(name))
        light[name] = scaleRadiance(light[name], strengths[role]);
    all.append(light);
  }
  return all;
}

QString qSlicerFenestraLights::makeFlag(const QString& rig, const Strengths& strengths) {
  const QJsonArray lights = readRig(rig);
  const QJsonArray changed = scaleLights(lights, strengths);
  if (changed == lights)
    return rig;
  const QJsonObject document = {{"lights", changed}};
  return QString::fromUtf8(QJsonDocument(document).toJson(QJsonDocument::Compact));
}

std::array<bool, 4> qSlicerFenestraLights::findLights(const QString& rig) {
  const std::vector<Role> roles = assignRoles(readRig(rig));
  std::array<bool, 4> has{};
  for (std::size_t role = key; role <= environment; ++role)
    has[role] = std::find(roles.begin(), roles.end(), role) != roles.end();
  return has;
}
