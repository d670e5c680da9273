#pragma once
// Files that a user saves: copies under new names, replacing only files that the user agreed to.

#include <QString>
#include <QStringList>

struct qFenestraCopy {
  QString source, target;
};

class qFenestraCopies {
public:
  /// `chosen`: file name from the user; `extension` is added if missing.
  static qFenestraCopies picture(const QString& source, const QString& chosen,
                                 const QString& extension);
  /// "turn.png" stands for turn_0000.png and so on, numbered like the sources.
  static qFenestraCopies frames(const QStringList& sources, const QString& chosen);

  /// Target files that exist: ask the user before replacing them.
  QStringList existingTargets() const;
  /// Copies one file after the other. Only a complete copy replaces a file. Returns the first
  /// target that failed, which is unchanged; empty: none.
  QString write() const;

  /// Target name, or the first and the last.
  QString names() const;

private:
  QList<qFenestraCopy> m_all;
};
