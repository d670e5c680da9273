#include "qFenestraCopies.h"

#include <QFile>
#include <QFileInfo>
#include <QObject>
#include <QSaveFile>

namespace {

bool copied(const qFenestraCopy& copy) {
  QFile in(copy.source);
  QSaveFile out(copy.target);
  // Unbuffered: Qt's commit does not report a failed write of its last buffer.
  if (!in.open(QIODevice::ReadOnly) || !out.open(QIODevice::WriteOnly | QIODevice::Unbuffered))
    return false;
  constexpr qint64 most = 1 << 20; // bytes per read
  while (!in.atEnd()) {
    const QByteArray part = in.read(most);
    if (part.isEmpty() || out.write(part) != part.size())
      return false;
  }
  return out.commit();
}

} // namespace

qFenestraCopies qFenestraCopies::picture(const QString& source, const QString& chosen,
                                         const QString& ending) {
  const bool has = chosen.endsWith(ending, Qt::CaseInsensitive);
  qFenestraCopies copies;
  copies.m_all.append({source, has ? chosen : chosen + ending});
  return copies;
}

qFenestraCopies qFenestraCopies::frames(const QStringList& sources, const QString& chosen) {
  const QString ending = QStringLiteral(".png");
  const bool has = chosen.endsWith(ending, Qt::CaseInsensitive);
  const QString stem = has ? chosen.chopped(ending.size()) : chosen;
  qFenestraCopies copies;
  for (const QString& source : sources) {
    const QString number = QFileInfo(source).completeBaseName().section('_', -1);
    copies.m_all.append({source, stem + "_" + number + ending});
  }
  return copies;
}

QStringList qFenestraCopies::existing() const {
  QStringList names;
  for (const qFenestraCopy& copy : m_all)
    if (QFileInfo::exists(copy.target) || QFileInfo(copy.target).isSymLink())
      names << copy.target;
  return names;
}

QString qFenestraCopies::write() const {
  for (const qFenestraCopy& copy : m_all)
    if (!copied(copy))
      return copy.target;
  return {};
}

QString qFenestraCopies::names() const {
  if (m_all.isEmpty())
    return {};
  const QString first = m_all.first().target, last = m_all.last().target;
  return first == last ? first : QObject::tr("%1 to %2").arg(first, QFileInfo(last).fileName());
}
