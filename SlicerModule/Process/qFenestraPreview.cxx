#include "qFenestraPreview.h"

#include "FenestraFlags.h"

#include <QJsonArray>
#include <QJsonDocument>

qFenestraPreview::qFenestraPreview(QObject* parent) : QObject(parent) {
  constexpr int resting = 60;
  m_rest.setSingleShot(true);
  m_rest.setInterval(resting);
  connect(&m_rest, &QTimer::timeout, this, &qFenestraPreview::tell);
}

void qFenestraPreview::start(const QString& program, const QStringList& arguments,
                             const QString& folder, const std::shared_ptr<const void>& files) {
  stop();
  m_told = 0;
  m_child = new qFenestraProgram(this);
  connect(m_child, &qFenestraProgram::said, this, &qFenestraPreview::hear);
  connect(m_child, &qFenestraProgram::ended, this, &qFenestraPreview::ended);
  connect(m_child, &QObject::destroyed, [files] {}); // the connection keeps the files
  m_child->run(program, QStringList{"serve"} + arguments, folder);
}

void qFenestraPreview::stop() {
  m_rest.stop();
  m_changes = {};
  if (!m_child)
    return;
  qFenestraProgram* const child = m_child;
  m_child = nullptr;
  disconnect(child, nullptr, this, nullptr);
  if (child->state() == QProcess::NotRunning)
    return child->deleteLater();
  connect(child, &qFenestraProgram::ended, child, &QObject::deleteLater);
  constexpr int grace = 150;
  child->closeWriteChannel(); // a server ends at the end of its input
  child->stop();
  QTimer::singleShot(grace, child, &qFenestraProgram::stop); // kills: no result is to be kept
}

void qFenestraPreview::change(const QJsonObject& flags) {
  for (auto flag = flags.begin(); flag != flags.end(); ++flag)
    m_changes[flag.key()] = flag.value();
  m_rest.start();
}

QJsonObject qFenestraPreview::valuesOf(const std::map<std::string, std::string>& flags) {
  QJsonObject all;
  for (const auto& [name, value] : flags) {
    QJsonArray texts;
    for (const std::string& text : SlicerExport::valuesOf(name, value))
      texts << QString::fromStdString(text);
    all[QString::fromStdString(name)] =
        SlicerExport::repeats(name) ? QJsonValue(texts) : texts.first();
  }
  return all;
}

void qFenestraPreview::tell() {
  if (!running() || m_changes.isEmpty())
    return;
  m_changes["id"] = ++m_told;
  m_child->write(QJsonDocument(m_changes).toJson(QJsonDocument::Compact) + '\n');
  m_changes = {};
}

void qFenestraPreview::hear(const QString& line) {
  const QJsonObject answer = QJsonDocument::fromJson(line.toUtf8()).object();
  if (answer["id"].toInt(0) != m_told)
    return;
  if (answer["event"] == "error")
    emit refused(answer["message"].toString());
  if (answer["event"] != "picture")
    return;
  qFenestraPicture picture;
  const QJsonArray files = answer["files"].toArray();
  for (const QJsonValue& file : files)
    picture.files << file.toString();
  picture.samples = answer["samples"].toInt();
  picture.noise = answer["noiseFiltered"].toDouble(answer["noise"].toDouble(-1.0));
  picture.seconds = answer["seconds"].toDouble();
  picture.done = answer["done"].toBool();
  emit refreshed(picture);
}
