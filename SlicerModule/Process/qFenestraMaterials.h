#pragma once
// Materials that the renderer chooses for segments, queried from the program.

#include "FenestraSceneFiles.h"
#include "qFenestraProgram.h"

#include <QList>
#include <QMap>

#include <optional>
#include <vector>

struct qFenestraMaterial {
  QString name;  ///< in the library; empty: only a color
  QString color; ///< displayed, sRGB, #rrggbb; empty: the volume's own
  QString why;   ///< reason such as "by name 'liver'"; empty for a material of the library
  bool isClipped = true;
};

struct qFenestraMaterials {
  QList<qFenestraMaterial> library;
  QMap<QString, qFenestraMaterial> bySegment; ///< automatic choices, by id

  /// Parses a report of `fenestra inspect --json`; no materials if it is invalid.
  static qFenestraMaterials parseReport(const QByteArray& report);
};

/// Queries the renderer. After a failure, `received` is emitted without materials.
class qFenestraMaterialsQuery : public QObject {
  Q_OBJECT

public:
  explicit qFenestraMaterialsQuery(QObject* parent = nullptr);
  /// Queries the materials of segments with these names, tags and colors. Follows a running query,
  /// whose result is then dropped. `folder`: private, for the query's file.
  void request(const QString& program, const std::vector<SlicerExport::Segment>& segments,
               const QString& folder);

signals:
  void received(const qFenestraMaterials& materials);

private:
  struct Query {
    QString program;
    std::vector<SlicerExport::Segment> segments;
    QString folder;
  };
  void start(const Query& query);
  void onEnded(const qFenestraOutcome& outcome);

  qFenestraProgram m_child;
  QByteArray m_output;
  bool m_running = false;      ///< a query is running
  std::optional<Query> m_next; ///< follows the running query
};
