#pragma once
// Files that a user saves: copied under other names, over files that they agreed to lose.

#include <QString>
#include <QStringList>

struct qFenestraCopy {
  QString source, target;
};

class qFenestraCopies {
public:
  /// `chosen` is what the user typed; without the ending it gets it.
  static qFenestraCopies picture(const QString& source, const QString& chosen,
                                 const QString& ending);
  /// turn.png stands for turn_0000.png and so on, numbered as the sources are.
  static qFenestraCopies frames(const QStringList& sources, const QString& chosen);

  /// Of the names that are written, those that are there already, and so are to be asked for.
  QStringList existing() const;
  /// Writes one after the other; each is whole before it takes the place of another file. Returns
  /// the name of the first that failed, which is as it was before; empty where none did.
  QString write() const;

  /// The name that is written, or the first and the last one.
  QString names() const;

private:
  QList<qFenestraCopy> m_all;
};
