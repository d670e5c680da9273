#include "qSlicerFenestraMeasures.h"

#include <QObject>

#include <algorithm>
#include <cmath>
#include <utility>

namespace {

enum class Unit { fraction, millimeters, slope, millimetersPerDegree };

struct MeasureInfo {
  const char* key;
  Unit unit;
  QString name, help;
};

/// Known measures, the most important first.
QList<MeasureInfo> listKnownMeasures() {
  const auto tr = [](const char* text) { return QObject::tr(text); };
  return {
      {"focusCoverage", Unit::fraction, tr("Focus visible"),
       tr("Percentage of the light from the focus that reaches the camera through the tissue in "
          "front")},
      {"focusCoverageUnclipped", Unit::fraction, tr("Focus visible without clipping"),
       tr("Percentage of the light from the focus that would reach the camera without clipping")},
      {"focusKept", Unit::fraction, tr("Focus kept"),
       tr("Percentage of the focus's pixels where clipping does not remove the focus itself")},
      {"focusLight", Unit::fraction, tr("Light on the focus"),
       tr("Direct light on the focus, relative to the focus without surroundings")},
      {"contextRemoved", Unit::fraction, tr("Surroundings removed"),
       tr("Percentage of the tissue outside the focus that clipping removes")},
      {"boundaryGapMm", Unit::millimeters, tr("Gap at the edge"),
       tr("Depth difference between the focus and the surface at the edge of the focus")},
      {"boundaryMismatchMm", Unit::millimeters, tr("Step at the edge"),
       tr("Depth difference between the outermost pixels of the focus and the surface beside "
          "them")},
      {"boundarySlopeJump", Unit::slope, tr("Kink at the edge"),
       tr("Change of the depth's slope at the edge of the focus: mm of depth per mm across")},
      {"boundaryDepthJumps", Unit::fraction, tr("Discontinuous edge"),
       tr("Percentage of the edge where the focus's own depth jumps; no gap is measured there")},
      {"surfaceChangeMmPerDegree", Unit::millimetersPerDegree, tr("Change during rotation"),
       tr("Change of the surface's depth from frame to frame")},
  };
}

QString formatNumber(double value, Unit unit) {
  if (unit == Unit::fraction) // 99.98 % must not read as 100.0 %
    return QString::number(100.0 * value, 'f', value > 0.99 && value < 1.0 ? 2 : 1);
  if (value < 0.001) // not 4.1e-07 mm
    return QString::number(value, 'f', 3);
  return value < 9.95 ? QString::number(value, 'g', 2) : QString::number(value, 'f', 0);
}

QString toSuffix(Unit unit) {
  switch (unit) {
  case Unit::fraction:
    return QObject::tr(" %");
  case Unit::millimeters:
    return QObject::tr(" mm");
  case Unit::millimetersPerDegree:
    return QObject::tr(" mm/\u00b0");
  case Unit::slope:
    return QObject::tr(" mm/mm");
  }
  return {};
}

/// Text of a number, or of a distribution: mean, 95th percentile and maximum.
QString toUserText(const QJsonValue& value, Unit unit) {
  if (value.isDouble())
    return formatNumber(value.toDouble(), unit) + toSuffix(unit);
  const QJsonObject object = value.toObject();
  QStringList parts;
  for (const auto& [key, text] :
       {std::pair{"mean", QObject::tr("mean %1")}, std::pair{"p95", QObject::tr("95 % below %1")},
        std::pair{"max", QObject::tr("at most %1")}})
    if (const QJsonValue part = object[QLatin1String(key)]; part.isDouble())
      parts << text.arg(formatNumber(part.toDouble(), unit));
  return parts.isEmpty() ? QString() : parts.join(", ") + toSuffix(unit);
}

} // namespace

QJsonObject qSlicerFenestraMeasures::selectMeasures(const QJsonObject& statistics) {
  QJsonObject measures;
  for (const MeasureInfo& one : listKnownMeasures()) {
    const QJsonValue value = statistics[QLatin1String(one.key)];
    if (value.isDouble() || value.isObject())
      measures[QLatin1String(one.key)] = value;
  }
  return measures;
}

QList<qSlicerFenestraMeasures::Measure>
qSlicerFenestraMeasures::toUserText(const QJsonObject& measures) {
  QList<Measure> all;
  for (const MeasureInfo& one : listKnownMeasures()) {
    const QString value = ::toUserText(measures[QLatin1String(one.key)], one.unit);
    if (!value.isEmpty())
      all.append({one.name, value, one.help});
  }
  return all;
}

QString qSlicerFenestraMeasures::formatDuration(double seconds) {
  if (seconds < 9.95)
    return QObject::tr("%1 s").arg(seconds, 0, 'f', 1);
  const auto rounded = static_cast<int>(std::lround(std::min(seconds, 1e6)));
  if (rounded < 60)
    return QObject::tr("%1 s").arg(rounded);
  return QObject::tr("%1 min %2 s").arg(rounded / 60).arg(rounded % 60);
}
