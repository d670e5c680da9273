#ifndef __qSlicerFenestraMeasures_h
#define __qSlicerFenestraMeasures_h

#include <QJsonObject>
#include <QList>
#include <QString>

#include "qSlicerFenestraModuleExport.h"

/// What the renderer measured of a picture, for people.
namespace qSlicerFenestraMeasures {

struct Measure {
  QString name, value, help;
};

/// Those of the statistics that are kept with a picture.
Q_SLICER_QTMODULES_FENESTRA_EXPORT QJsonObject kept(const QJsonObject& statistics);

/// In words, those that are there.
Q_SLICER_QTMODULES_FENESTRA_EXPORT QList<Measure> inWords(const QJsonObject& measures);

/// "4.2 s", "42 s", "3 min 7 s".
Q_SLICER_QTMODULES_FENESTRA_EXPORT QString duration(double seconds);

} // namespace qSlicerFenestraMeasures

#endif
