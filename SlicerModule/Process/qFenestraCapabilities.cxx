#include "qFenestraCapabilities.h"

#include <QDir>
#include <QRegularExpression>
#include <QXmlStreamReader>

/// True if the flag's description has `word` as a separate word.
bool qFenestraCapabilities::mentions(const QString& flag, const QString& word) const {
  const QRegularExpression regex("(^|[\\s(,])" + QRegularExpression::escape(word) + "([\\s),.]|$)");
  return regex.match(flags.value(flag).text).hasMatch();
}

QMap<QString, qFenestraCapabilities::Flag>
qFenestraCapabilities::parseFlags(const QString& description) {
  QMap<QString, Flag> all;
  QXmlStreamReader xml(description);
  QString name;
  Flag flag;
  while (!xml.atEnd()) {
    xml.readNext();
    if (!xml.isStartElement())
      continue;
    if (xml.name() == QLatin1String("parameters"))
      name.clear(); // a group of flags follows
    else if (xml.name() == QLatin1String("name"))
      name = xml.readElementText(), flag = {};
    else if (xml.name() == QLatin1String("description") && !name.isEmpty())
      flag.text = xml.readElementText();
    else if (xml.name() == QLatin1String("element"))
      flag.choices << xml.readElementText();
    if (!name.isEmpty())
      all[name] = flag;
  }
  return xml.hasError() ? QMap<QString, Flag>() : all;
}

qFenestraCapabilityQuery::qFenestraCapabilityQuery(QObject* parent) : QObject(parent) {
  connect(&m_child, &qFenestraProgram::lineReceived, this,
          [this](const QString& line) { m_output += line + '\n'; });
  connect(&m_child, &qFenestraProgram::ended, this, &qFenestraCapabilityQuery::onEnded);
}

void qFenestraCapabilityQuery::request(const QString& program) {
  m_program = program;
  m_child.run(m_program, {"--xml"}, QDir::tempPath());
}

void qFenestraCapabilityQuery::onEnded(const qFenestraOutcome& outcome) {
  const bool isDone = outcome.kind == qFenestraOutcome::Kind::done;
  if (!m_flagsKnown && isDone) {
    m_capabilities.flags = qFenestraCapabilities::parseFlags(m_output);
    m_flagsKnown = true;
    m_output.clear();
    m_child.run(m_program, {"turntable", "--help"}, QDir::tempPath());
    return;
  }
  // Old renderers take "turntable" for a file name and print the help of `fenestra render`.
  if (m_flagsKnown && isDone && m_output.contains("--frames"))
    m_capabilities.turntable = m_output;
  emit received(m_capabilities);
}
