#pragma once
// Materials of segments as the renderer chooses them, queried from the program.

#include "FenestraSceneFiles.h"
#include "qFenestraProgram.h"

#include <QList>
#include <QMap>

#include <optional>
#include <vector>

struct qFenestraMaterial {
  QString name;  ///< of the library; empty: a colour alone
  QString color; ///< seen, sRGB, #rrggbb; empty: the volume's own
  QString why;   ///< words such as "by name 'liver'"; empty for a material of the library
  bool isClipped = true;
};

struct qFenestraMaterials {
  QList<qFenestraMaterial> library;
  QMap<QString, qFenestraMaterial> bySegment; ///< automatic choices, by id

  /// Materials in a report of `fenestra inspect --json`; none if it is invalid.
  static qFenestraMaterials parseReport(const QByteArray& report);
};

/// Queries the renderer. Without an answer, `told` is emitted with nothing.
class qFenestraMaterialsQuery : public QObject {
  Q_OBJECT

public:
  explicit qFenestraMaterialsQuery(QObject* parent = nullptr);
  /// Asks about the segments, by names, tags and colours; a question under way is answered first.
  /// `folder`: private, for the question's file.
  void request(const QString& program, const std::vector<SlicerExport::Segment>& segments,
               const QString& folder);

signals:
  void told(const qFenestraMaterials& materials);

private:
  struct Query {
    QString program;
    std::vector<SlicerExport::Segment> segments;
    QString folder;
  };
  void start(const Query& question);
  void onEnded(const qFenestraOutcome& outcome);

  qFenestraProgram m_child;
  QByteArray m_output;
  bool m_running = false;      ///< a question is under way
  std::optional<Query> m_next; ///< question to be asked then
};
