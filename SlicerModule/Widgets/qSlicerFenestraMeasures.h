#ifndef __qSlicerFenestraMeasures_h
#define __qSlicerFenestraMeasures_h

#include <QJsonObject>
#include <QList>
#include <QString>

#include "qSlicerFenestraModuleExport.h"

/// Quality measures of a rendered image, as text for users.
namespace qSlicerFenestraMeasures {

struct Measure {
  QString name, value, help;
};

/// Selects the statistics that are stored with an image.
Q_SLICER_QTMODULES_FENESTRA_EXPORT QJsonObject selectMeasures(const QJsonObject& statistics);

/// Formats the measures that exist.
Q_SLICER_QTMODULES_FENESTRA_EXPORT QList<Measure> toUserText(const QJsonObject& measures);

/// Duration as text: "4.2 s", "42 s", "3 min 7 s".
Q_SLICER_QTMODULES_FENESTRA_EXPORT QString formatDuration(double seconds);

} // namespace qSlicerFenestraMeasures

#endif
