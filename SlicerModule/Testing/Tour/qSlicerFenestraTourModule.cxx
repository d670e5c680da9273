#include "qSlicerFenestraTourModule.h"

#include "qSlicerFenestraTour.h"

#include <qSlicerApplication.h>

#include <QTimer>

void qSlicerFenestraTourModule::setup() {
  Superclass::setup();
  const QString report = qEnvironmentVariable("FENESTRA_TOUR");
  if (report.isEmpty())
    return;
  constexpr int settled = 2000; // milliseconds
  connect(qSlicerApplication::application(), &qSlicerApplication::startupCompleted, this, [report] {
    QTimer::singleShot(settled, [report] {
      const bool good = qSlicerFenestraTour(report).run();
      qSlicerApplication::exit(good ? 0 : 1);
    });
  });
}
