// Texts of the renderer's quality measures.

#include "FenestraTesting.h"

#include "qSlicerFenestraMeasures.h"

#include <QJsonDocument>

int qSlicerFenestraMeasuresTest1(int, char*[]) {
  using namespace qSlicerFenestraMeasures;
  const QJsonObject statistics =
      QJsonDocument::fromJson(R"({"seconds": {"total": 1}, "noise": 0.1, "focusCoverage": 0.99875,
                                  "contextRemoved": 0.25, "focusLight": null,
                                  "boundaryGapMm": {"mean": 0.0123, "p95": 0.05, "max": 1.5},
                                  "boundarySlopeJump": {"mean": 4.1e-7, "p95": 0.00099, "max": 54}})")
          .object();
  const QJsonObject measures = selectMeasures(statistics);
  CHECK_INT(measures.size(), 4);
  CHECK_INT(selectMeasures({}).size(), 0);
  const QList<Measure> words = toUserText(measures);
  CHECK_INT(static_cast<int>(words.size()), 4);
  CHECK_STD_STRING(words[0].name.toStdString(), "Focus visible");
  CHECK_STD_STRING(words[0].value.toStdString(), "99.88 %");
  CHECK_STD_STRING(words[1].value.toStdString(), "25.0 %");
  CHECK_STD_STRING(words[2].value.toStdString(), "mean 0.012, 95 % below 0.05, at most 1.5 mm");
  CHECK_STD_STRING(words[3].value.toStdString(), "mean 0.000, 95 % below 0.001, at most 54 mm/mm");
  for (const Measure& one : words)
    CHECK_BOOL(one.help.isEmpty(), false);
  // Invalid measures are skipped: a scene's attribute may hold any text.
  CHECK_INT(static_cast<int>(toUserText({{"focusCoverage", "x"}, {"boundaryGapMm", 1}}).size()), 1);
  for (const auto& [seconds, text] :
       {std::pair{0.04, "0.0 s"}, {9.96, "10 s"}, {59.7, "1 min 0 s"}, {187.2, "3 min 7 s"}})
    CHECK_STD_STRING(formatDuration(seconds).toStdString(), text);
  return EXIT_SUCCESS;
}
