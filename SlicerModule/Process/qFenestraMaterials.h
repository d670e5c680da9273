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
  QMap<QString, qFenestraMaterial> ofSegments; ///< automatic choices, by id

  /// Materials in a report of `fenestra inspect --json`; none if it is invalid.
  static qFenestraMaterials in(const QByteArray& report);
};

/// Queries the renderer. Without an answer, `told` is emitted with nothing.
class qFenestraMaterialsQuestion : public QObject {
  Q_OBJECT

public:
  explicit qFenestraMaterialsQuestion(QObject* parent = nullptr);
  /// Asks about the segments, by names, tags and colours; a question under way is answered first.
  /// `folder`: private, for the question's file.
  void ask(const QString& program, const std::vector<SlicerExport::Segment>& segments,
           const QString& folder);

signals:
  void told(const qFenestraMaterials& materials);

private:
  struct Question {
    QString program;
    std::vector<SlicerExport::Segment> segments;
    QString folder;
  };
  void start(const Question& question);
  void hear(const qFenestraOutcome& outcome);

  qFenestraProgram m_child;
  QByteArray m_said;
  bool m_asked = false;           ///< a question is under way
  std::optional<Question> m_next; ///< question to be asked then
};
