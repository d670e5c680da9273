#ifndef __qSlicerFenestraMeasures_h
#define __qSlicerFenestraMeasures_h

#include <QJsonObject>
#include <QList>
#include <QString>

#include "qSlicerFenestraModuleExport.h"

/// Measures of a picture by the renderer, in words for users.
namespace qSlicerFenestraMeasures {

struct Measure {
  QString name, value, help;
};

/// Statistics to be stored with a picture.
Q_SLICER_QTMODULES_FENESTRA_EXPORT QJsonObject selectMeasures(const QJsonObject& statistics);

/// Existing measures, in words.
Q_SLICER_QTMODULES_FENESTRA_EXPORT QList<Measure> toUserText(const QJsonObject& measures);

/// Duration as text: "4.2 s", "42 s", "3 min 7 s".
Q_SLICER_QTMODULES_FENESTRA_EXPORT QString formatDuration(double seconds);

} // namespace qSlicerFenestraMeasures

#endif
