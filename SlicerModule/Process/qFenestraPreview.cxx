#include "qFenestraPreview.h"

#include "FenestraFlags.h"

#include <QDir>
#include <QJsonArray>
#include <QJsonDocument>

#include <stdexcept>

namespace {
constexpr const char* frameFile = "preview.frame";
} // namespace

qFenestraPreview::qFenestraPreview(QObject* parent) : QObject(parent) {
  m_delay.setSingleShot(true);
  connect(&m_delay, &QTimer::timeout, this, &qFenestraPreview::sendChanges);
}

void qFenestraPreview::start(const QString& program, const QStringList& arguments,
                             const QString& folder, const std::shared_ptr<const void>& files) {
  stop();
  m_lastId = 0;
  m_child = new qFenestraProgram(this);
  connect(m_child, &qFenestraProgram::lineReceived, this, &qFenestraPreview::readEvent);
  connect(m_child, &qFenestraProgram::ended, this, &qFenestraPreview::ended);
  connect(m_child, &QObject::destroyed, [files] {}); // the connection keeps the files alive
  m_file.setFileName(QDir(folder).filePath(frameFile));
  m_child->run(program,
               QStringList{"serve", QString("--mapped-image=%1").arg(frameFile)} + arguments,
               folder);
}

void qFenestraPreview::stop() {
  m_delay.stop();
  m_changes = {};
  m_isWaiting = false;
  closeFrame();
  if (!m_child)
    return;
  qFenestraProgram* const child = m_child;
  m_child = nullptr;
  disconnect(child, nullptr, this, nullptr);
  if (child->state() == QProcess::NotRunning)
    return child->deleteLater();
  connect(child, &qFenestraProgram::ended, child, &QObject::deleteLater);
  constexpr int graceMs = 150;
  child->closeWriteChannel(); // `fenestra serve` ends with its input
  child->stop();
  QTimer::singleShot(graceMs, child, &qFenestraProgram::stop); // kills: there is no result to keep
}

void qFenestraPreview::change(const QJsonObject& flags) {
  for (auto flag = flags.begin(); flag != flags.end(); ++flag)
    m_changes[flag.key()] = flag.value();
  if (!m_delay.isActive())
    m_delay.start();
}

void qFenestraPreview::pause() {
  if (!running())
    return;
  m_delay.stop(); // what is not sent yet goes with the next change
  m_child->write(QByteArrayLiteral("{\"pause\": true}\n"));
  m_isWaiting = false; // the last change may get no reply
}

QJsonObject qFenestraPreview::toJson(const std::map<std::string, std::string>& flags) {
  QJsonObject all;
  for (const auto& [name, value] : flags) {
    QJsonArray values;
    for (const std::string& text : SlicerExport::toArgumentValues(name, value))
      values << QString::fromStdString(text);
    all[QString::fromStdString(name)] =
        SlicerExport::isRepeatable(name) ? QJsonValue(values) : values.first();
  }
  return all;
}

void qFenestraPreview::sendChanges() {
  if (!running() || m_changes.isEmpty() || m_isWaiting)
    return;
  m_changes["id"] = ++m_lastId;
  m_child->write(QJsonDocument(m_changes).toJson(QJsonDocument::Compact) + '\n');
  m_changes = {};
  m_isWaiting = true;
}

void qFenestraPreview::readEvent(const QString& line) {
  const QJsonObject reply = QJsonDocument::fromJson(line.toUtf8()).object();
  if (reply["id"].toInt(0) != m_lastId)
    return;
  m_isWaiting = false;
  m_delay.start();
  if (reply["event"] == "error")
    emit refused(reply["message"].toString());
  if (reply["event"] != "picture")
    return;
  qFenestraPreviewImage image;
  try {
    image.frame = readFrame();
  } catch (const std::runtime_error& error) {
    return emit refused(error.what());
  }
  if (!image.frame || image.frame->request != (m_lastId > 0 ? m_lastId : -1))
    return;
  image.seconds = reply["seconds"].toDouble();
  image.isCurrent = m_changes.isEmpty();
  emit refreshed(image);
}

std::shared_ptr<const SlicerExport::Frame> qFenestraPreview::readFrame() {
  using State = SlicerExport::FrameState;
  const auto frame = std::make_shared<SlicerExport::Frame>();
  State state = State::outgrown;
  for (int tries = 0; state == State::outgrown && tries < 2; ++tries) {
    if (!m_memory && m_file.open(QIODevice::ReadOnly)) {
      m_memoryBytes = m_file.size(); // the file may grow
      m_memory = m_file.map(0, m_memoryBytes);
    }
    if (!m_memory) {
      closeFrame();
      throw std::runtime_error("The renderer's image could not be read.");
    }
    state = SlicerExport::readFrame(m_memory, static_cast<std::size_t>(m_memoryBytes), *frame);
    if (state == State::outgrown)
      closeFrame();
  }
  return state == State::complete ? frame : nullptr;
}

void qFenestraPreview::closeFrame() {
  m_file.close(); // unmaps
  m_memory = nullptr;
}
