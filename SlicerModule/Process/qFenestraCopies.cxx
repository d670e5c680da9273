#include "qFenestraCopies.h"

#include <QFile>
#include <QFileInfo>
#include <QObject>
#include <QSaveFile>

namespace {

bool copyFile(const qFenestraCopy& copy) {
  QFile in(copy.source);
  QSaveFile out(copy.target);
  // Unbuffered, because QSaveFile::commit() does not report a failed write of the last buffer.
  if (!in.open(QIODevice::ReadOnly) || !out.open(QIODevice::WriteOnly | QIODevice::Unbuffered))
    return false;
  constexpr qint64 chunkSize = 1 << 20; // bytes per read
  while (!in.atEnd()) {
    const QByteArray chunk = in.read(chunkSize);
    if (chunk.isEmpty() || out.write(chunk) != chunk.size())
      return false;
  }
  return out.commit();
}

} // namespace

qFenestraCopies qFenestraCopies::picture(const QString& source, const QString& chosen,
                                         const QString& extension) {
  const bool hasExtension = chosen.endsWith(extension, Qt::CaseInsensitive);
  qFenestraCopies copies;
  copies.m_all.append({source, hasExtension ? chosen : chosen + extension});
  return copies;
}

qFenestraCopies qFenestraCopies::frames(const QStringList& sources, const QString& chosen) {
  const QString extension = QStringLiteral(".png");
  const bool hasExtension = chosen.endsWith(extension, Qt::CaseInsensitive);
  const QString stem = hasExtension ? chosen.chopped(extension.size()) : chosen;
  qFenestraCopies copies;
  for (const QString& source : sources) {
    const QString number = QFileInfo(source).completeBaseName().section('_', -1);
    copies.m_all.append({source, stem + "_" + number + extension});
  }
  return copies;
}

QStringList qFenestraCopies::existingTargets() const {
  QStringList names;
  for (const qFenestraCopy& copy : m_all)
    if (QFileInfo::exists(copy.target) || QFileInfo(copy.target).isSymLink())
      names << copy.target;
  return names;
}

QString qFenestraCopies::write() const {
  for (const qFenestraCopy& copy : m_all)
    if (!copyFile(copy))
      return copy.target;
  return {};
}

QString qFenestraCopies::names() const {
  if (m_all.isEmpty())
    return {};
  const QString first = m_all.first().target, last = m_all.last().target;
  return first == last ? first : QObject::tr("%1 to %2").arg(first, QFileInfo(last).fileName());
}
