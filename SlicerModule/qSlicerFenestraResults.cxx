#include "qSlicerFenestraResults.h"

#include "qSlicerFenestraMeasures.h"
#include "vtkSlicerFenestraLogic.h"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QJsonDocument>
#include <QJsonObject>
#include <QObject>

#include <algorithm>

namespace {

using Node = vtkMRMLFenestraRenderNode;

QJsonObject readStatistics(const QString& folder) {
  QFile file(folder + "/stats.json");
  if (!file.open(QIODevice::ReadOnly))
    return {};
  return QJsonDocument::fromJson(file.readAll()).object();
}

QString formatStatistics(const QJsonObject& stats) {
  return stats.isEmpty()
             ? QString()
             : QObject::tr("%1 samples per pixel, noise %2, %3")
                   .arg(stats["samplesPerPixel"].toObject()["mean"].toDouble(), 0, 'f', 0)
                   .arg(stats["noiseDenoised"].toDouble(stats["noise"].toDouble()), 0, 'g', 2)
                   .arg(qSlicerFenestraMeasures::formatDuration(
                       stats["seconds"].toObject()["total"].toDouble()));
}

QString formatTurntable(Node* render) {
  return QObject::tr("%1 of %2 frames, %3\u00b0")
      .arg(vtkSlicerFenestraLogic::GetNumberOfFrames(render))
      .arg(QString::fromStdString(render->GetFlag("frames")),
           QString::fromStdString(render->GetFlag("degrees")));
}

/// Stores a summary and the measures in the node.
void describe(Node* render, const QJsonObject& stats) {
  const QString line = render->IsTurntable() ? formatTurntable(render) : formatStatistics(stats);
  render->SetDescription(line.toUtf8().constData());
  const QJsonObject measures = qSlicerFenestraMeasures::selectMeasures(stats);
  if (!measures.isEmpty())
    render->SetAttribute(Node::MeasuresAttribute,
                         QJsonDocument(measures).toJson(QJsonDocument::Compact).constData());
}

} // namespace

void qSlicerFenestraResults::add(Node* render, const QString& folder) {
  describe(render, readStatistics(folder));
  const auto isReplaced = [render, &folder](const Result& one) {
    const bool replaced = !one.node || one.node == render;
    if (replaced && one.folder != folder)
      QDir(one.folder).removeRecursively();
    return replaced;
  };
  m_all.erase(std::remove_if(m_all.begin(), m_all.end(), isReplaced), m_all.end());
  m_all.append({render, folder});
}

QString qSlicerFenestraResults::findFolder(Node* render) const {
  const auto found = std::find_if(m_all.begin(), m_all.end(),
                                  [render](const Result& one) { return one.node == render; });
  return render && found != m_all.end() ? found->folder : QString();
}

QString qSlicerFenestraResults::findFile(Node* render, const QString& extension) const {
  const QString folder = findFolder(render);
  const QString file = folder + "/picture." + extension;
  return !folder.isEmpty() && QFileInfo::exists(file) ? file : QString();
}

QStringList qSlicerFenestraResults::findFrames(Node* turntable) const {
  const QString folder = findFolder(turntable);
  QStringList files;
  if (!folder.isEmpty())
    for (const std::string& file : vtkSlicerFenestraLogic::GetFrameFiles(folder.toStdString()))
      files << QString::fromStdString(file);
  return files;
}

bool qSlicerFenestraResults::lacksFrames(Node* render) const {
  const QString folder = findFolder(render);
  return !folder.isEmpty() && render->IsTurntable() && QFileInfo::exists(folder + "/scene.mrml") &&
         vtkSlicerFenestraLogic::GetNumberOfFrames(render) <
             QString::fromStdString(render->GetFlag("frames")).toInt();
}
