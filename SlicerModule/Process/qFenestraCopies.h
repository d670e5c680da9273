#pragma once
// Files that a user saves: copies under new names, replacing files that the user agreed to lose.

#include <QString>
#include <QStringList>

struct qFenestraCopy {
  QString source, target;
};

class qFenestraCopies {
public:
  /// `chosen`: the user's text; `ending` is added if missing.
  static qFenestraCopies picture(const QString& source, const QString& chosen,
                                 const QString& extension);
  /// turn.png stands for turn_0000.png and so on, numbered like the sources.
  static qFenestraCopies frames(const QStringList& sources, const QString& chosen);

  /// Target files that exist: the user must be asked before they are replaced.
  QStringList existingTargets() const;
  /// Copies one file after the other; each is complete before it replaces another file. Returns the
  /// first target that failed, which is left unchanged; empty: none.
  QString write() const;

  /// Target name, or the first and the last.
  QString names() const;

private:
  QList<qFenestraCopy> m_all;
};
