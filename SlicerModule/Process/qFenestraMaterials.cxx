#include "qFenestraMaterials.h"

#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>

#include <cmath>

namespace {

/// Color of three numbers in [0, 1], or of the middle one of knots [scalar, color]; empty: none.
QString parseColor(const QJsonArray& json) {
  if (json.isEmpty() || json.first().isArray())
    return json.isEmpty() ? QString() : parseColor(json[json.size() / 2].toArray()[1].toArray());
  QString text = "#";
  for (const QJsonValue& part : json)
    text += QString("%1").arg(std::lround(255.0 * part.toDouble()), 2, 16, QChar('0'));
  return text;
}

qFenestraMaterial parseMaterial(const QJsonObject& json) {
  return {json["name"].toString(), parseColor(json["color"].toArray()), json["why"].toString(),
          json["clip"].toBool(true)};
}

} // namespace

qFenestraMaterials qFenestraMaterials::parseReport(const QByteArray& report) {
  const QJsonObject root = QJsonDocument::fromJson(report).object();
  qFenestraMaterials all;
  const QJsonArray library = root["materials"].toArray();
  for (const QJsonValue& one : library)
    all.library << parseMaterial(one.toObject());
  const QJsonArray segments =
      root["segmentations"].toArray().first().toObject()["segments"].toArray();
  for (const QJsonValue& one : segments) {
    const QJsonObject segment = one.toObject();
    all.bySegment[segment["id"].toString()] = parseMaterial(segment["material"].toObject());
  }
  return all;
}

qFenestraMaterialsQuery::qFenestraMaterialsQuery(QObject* parent) : QObject(parent) {
  connect(&m_child, &qFenestraProgram::lineReceived, this,
          [this](const QString& line) { m_output += line.toUtf8() + '\n'; });
  connect(&m_child, &qFenestraProgram::ended, this, &qFenestraMaterialsQuery::onEnded);
}

void qFenestraMaterialsQuery::request(const QString& program,
                                      const std::vector<SlicerExport::Segment>& segments,
                                      const QString& folder) {
  if (m_running)
    m_next = Query{program, segments, folder};
  else
    start({program, segments, folder});
}

void qFenestraMaterialsQuery::start(const Query& query) {
  constexpr const char* name = "names.seg.nrrd";
  m_output.clear();
  try {
    SlicerExport::writeSegmentNames(query.segments,
                                    std::filesystem::path(query.folder.toStdString()) / name);
  } catch (const SlicerExport::FileError&) { // a render reports the reason
    emit received({});
    return;
  }
  m_running = true;
  m_child.run(query.program, {"inspect", name, "--json"}, query.folder);
}

void qFenestraMaterialsQuery::onEnded(const qFenestraOutcome& outcome) {
  m_running = false;
  if (const std::optional<Query> next = std::move(m_next)) {
    m_next.reset();
    return start(*next);
  }
  const bool isDone = outcome.kind == qFenestraOutcome::Kind::done;
  emit received(isDone ? qFenestraMaterials::parseReport(m_output) : qFenestraMaterials());
}
