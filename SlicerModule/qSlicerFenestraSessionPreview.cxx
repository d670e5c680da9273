// The session's preview, which follows the settings.

#include "qSlicerFenestraSession.h"

#include "FenestraFlags.h"
#include "FenestraMaterials.h"

#include <QCryptographicHash>
#include <QDir>
#include <QFile>
#include <QFileInfo>

#include <vtkMRMLScene.h>

#include <sstream>

namespace {

using Node = vtkMRMLFenestraRenderNode;

/// Key of the data whose change requires another preview process: volume, segmentation, transforms,
/// crop box.
std::string makeDataKey(const SlicerExport::Contents& contents) {
  std::ostringstream text;
  text.precision(17);
  text << contents.volumeKey << '\n' << contents.segmentationKey << '\n';
  for (const double element : contents.volumeToWorld)
    text << element << ' ';
  for (const double element : contents.segmentation.toWorld)
    text << element << ' ';
  for (const SlicerExport::Roi& roi : contents.crop)
    text << roi.markup;
  return text.str();
}

/// Size with the image's aspect ratio, at most 256 x 256, for speed.
std::string scaleToPreview(const std::string& size) {
  const QStringList words = QString::fromStdString(size).split('x');
  const QSize scaled = QSize(words.value(0, "512").toInt(), words.value(1, "512").toInt())
                           .scaled(256, 256, Qt::KeepAspectRatio)
                           .expandedTo({16, 16});
  return QString("%1x%2").arg(scaled.width()).arg(scaled.height()).toStdString();
}

} // namespace

void qSlicerFenestraSession::preview(Node* settings) {
  m_previewed = settings;
  if (!previewed())
    m_preview.stop();
  refresh();
}

void qSlicerFenestraSession::previewView(Node* settings, const Flags& view) {
  m_viewed = settings;
  m_viewFlags = view;
  m_sentFlags.remove("size"); // so that each request gives an image
  preview(m_previewed);
}

void qSlicerFenestraSession::pausePreview() {
  m_refreshTimer.stop(); // the request of the former view
  m_preview.pause();
}

void qSlicerFenestraSession::refresh() {
  if (previewed() && !m_refreshTimer.isActive())
    m_refreshTimer.start();
}

void qSlicerFenestraSession::updatePreview() {
  Node* const settings = previewed();
  if (!settings || !settings->GetScene() || isRendering())
    return;
  if (m_starting)
    return m_refreshTimer.start(); // sends the changes later
  try {
    const SlicerExport::Contents contents =
        m_logic->Snapshot(settings, m_files->folder.path().toStdString());
    const Flags flags = adaptFlags(m_logic->GetFlags(settings), contents);
    if (!m_preview.running() || makeDataKey(contents) != m_previewKey)
      return startPreview(contents, flags);
    sendToPreview(qFenestraPreview::toJson(flags));
  } catch (const SlicerExport::UserError& error) {
    m_preview.stop(); // it shows other data
    emit previewRefused(QString::fromUtf8(error.what()));
  }
}

void qSlicerFenestraSession::startPreview(const SlicerExport::Contents& contents,
                                          const Flags& flags) {
  m_starting = true;
  m_preview.stop(); // it shows other data
  m_previewKey = makeDataKey(contents);
  write(contents, [this, flags, files = m_files](const QString& scene, const QString& message) {
    m_starting = false;
    if (!message.isEmpty())
      return emit previewRefused(message);
    if (!previewed())
      return removeFolder(QFileInfo(scene).absolutePath());
    QStringList arguments = {scene};
    for (const std::string& argument : SlicerExport::toArguments(flags))
      arguments << QString::fromStdString(argument);
    m_sentFlags = qFenestraPreview::toJson(flags);
    const QString folder = QFileInfo(scene).absolutePath();
    if (isRendering() || files != m_files) // or the scene was closed during the writing
      return removeFolder(folder);
    arguments << qSlicerFenestraApplicationSettings::makeDeviceArguments()
              << qSlicerFenestraApplicationSettings::makeThreadArguments();
    m_preview.start(program(), arguments, folder, files);
    removeFolder(m_previewFolder);
    m_previewFolder = folder;
  });
}

/// The node's flags, adapted to a preview.
std::map<std::string, std::string>
qSlicerFenestraSession::adaptFlags(Flags flags, const SlicerExport::Contents& contents) const {
  flags = SlicerExport::filterMaterialFlags(contents.segmentation.segments, std::move(flags));
  for (const char* name : {"seconds", "seed", "samples"})
    flags.erase(name);
  for (const std::string& name : Node::GetTurntableFlagNames())
    flags.erase(name);
  flags["noise"] = "0.03";
  flags["size"] = scaleToPreview(flags["size"]);
  if (m_viewed) {
    for (const char* name : {"view", "scale", "angle", "annotate"})
      flags.erase(name);
    for (const auto& [name, value] : m_viewFlags)
      flags[name] = value;
  }
  if (flags.count("transfer") == 0 && flags.count("preset") == 0 && !contents.property.empty())
    flags["transfer"] = writePropertyFile(contents).toStdString();
  return flags;
}

/// Writes the transfer function to a file named by its hash, so that a change gives another file.
QString qSlicerFenestraSession::writePropertyFile(const SlicerExport::Contents& contents) const {
  const QByteArray text = QByteArray::fromStdString(contents.property);
  const QString name = QCryptographicHash::hash(text, QCryptographicHash::Sha1).toHex();
  QFile file(m_files->folder.filePath(name + QString::fromStdString(contents.propertyExtension)));
  if (file.size() != text.size() &&
      (!file.open(QIODevice::WriteOnly) || file.write(text) != text.size()))
    throw SlicerExport::UserError("The transfer function could not be written. " +
                                  file.errorString().toStdString() + ".");
  return file.fileName();
}

void qSlicerFenestraSession::sendToPreview(const QJsonObject& flags) {
  QJsonObject changed;
  for (auto flag = m_sentFlags.begin(); flag != m_sentFlags.end(); ++flag)
    if (!flags.contains(flag.key()))
      changed[flag.key()] = QJsonValue::Null; // not set any more
  for (auto flag = flags.begin(); flag != flags.end(); ++flag)
    if (m_sentFlags.value(flag.key()) != flag.value())
      changed[flag.key()] = flag.value();
  m_sentFlags = flags;
  if (!changed.isEmpty())
    m_preview.change(changed);
}

void qSlicerFenestraSession::showPreview(const qFenestraPreviewImage& picture) {
  const SlicerExport::Frame& frame = *picture.frame;
  const QImage image(frame.display.data(), frame.width, frame.height, QImage::Format_RGBA8888);
  qFenestraPreviewImage received = picture;
  received.isCurrent = picture.isCurrent && !m_starting && !m_refreshTimer.isActive();
  emit previewReceived(image.copy(), received);
}
