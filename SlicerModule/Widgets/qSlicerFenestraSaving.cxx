#include "qSlicerFenestraSaving.h"

#include "qFenestraCopies.h"
#include "qSlicerFenestraResults.h"
#include "vtkMRMLFenestraRenderNode.h"

#include <QCoreApplication>
#include <QDebug>
#include <QFileDialog>
#include <QMessageBox>

namespace {

QString tr(const char* text, int count = -1) {
  return QCoreApplication::translate("qSlicerFenestraSaving", text, nullptr, count);
}

QString logFailure(const QString& message) {
  qWarning().noquote() << "Fenestra:" << message;
  return message;
}

/// Asks before files are replaced.
QString saveAs(const qFenestraCopies& copies, QWidget* parent) {
  const QStringList replaced = copies.existingTargets();
  const QString question = replaced.size() == 1
                               ? tr("%1 already exists. Replace it?").arg(replaced.first())
                               : tr("%n files already exist, the first is %1. Replace them?",
                                    static_cast<int>(replaced.size()))
                                     .arg(replaced.value(0));
  if (!replaced.isEmpty() &&
      QMessageBox::question(parent, tr("Save"), question) != QMessageBox::Yes)
    return {};
  const QString failed = copies.write();
  return failed.isEmpty()
             ? tr("Saved as %1.").arg(copies.names())
             : logFailure(tr("%1 could not be written and is unchanged. Choose another folder.")
                              .arg(failed));
}

} // namespace

QString qSlicerFenestraSaving::save(vtkMRMLFenestraRenderNode* render,
                                    const qSlicerFenestraResults& results, QWidget* parent) {
  const bool isTurntable = render->IsTurntable();
  const QStringList frames = results.findFrames(render);
  if (isTurntable ? frames.isEmpty() : results.findFile(render, "png").isEmpty())
    return logFailure(tr("The files of this image were removed with the session that rendered it. "
                         "Press Repeat, then save."));
  const QString png = isTurntable ? tr("Numbered images (*.png)") : tr("Image (*.png)");
  const QString exr = tr("Linear color and depth (*.exr)");
  // Overwriting is confirmed for the final names, which may gain an extension or a number.
  const QString chosen = QFileDialog::getSaveFileName(
      parent, isTurntable ? tr("Save numbered frames") : tr("Save image"),
      QString::fromUtf8(render->GetName()) + ".png", isTurntable ? png : png + ";;" + exr, nullptr,
      QFileDialog::DontConfirmOverwrite);
  if (chosen.isEmpty())
    return {};
  const QString ending = chosen.endsWith(".exr", Qt::CaseInsensitive) ? "exr" : "png";
  const QString picture = results.findFile(render, ending);
  return saveAs(isTurntable ? qFenestraCopies::frames(frames, chosen)
                            : qFenestraCopies::picture(picture, chosen, "." + ending),
                parent);
}
