#pragma once
// What the renderer knows, asked of itself, so that a user is offered nothing that it refuses.

#include "qFenestraProgram.h"

#include <QMap>

struct qFenestraAbilities {
  struct Flag {
    QString text;      ///< the description
    QStringList words; ///< all that it takes, where those are fixed
  };
  QMap<QString, Flag> flags; ///< of a picture, by name
  QString turntable;         ///< the help of `fenestra turntable`; empty where there is none

  bool takes(const QString& flag, const QString& word) const {
    return flags.value(flag).words.contains(word);
  }
  bool names(const QString& flag, const QString& word) const;
  bool turns() const { return !turntable.isEmpty(); }

  /// Of the description for Slicer (.xml); no flags where it is none.
  static QMap<QString, Flag> flagsIn(const QString& description);
};

/// Asks once. Who is not answered knows nothing: `told` comes with empty abilities, too.
class qFenestraQuestion : public QObject {
  Q_OBJECT

public:
  explicit qFenestraQuestion(QObject* parent = nullptr);
  void ask(const QString& program);

signals:
  void told(const qFenestraAbilities& abilities);

private:
  void hear(const qFenestraOutcome& outcome);

  QString m_program, m_said;
  qFenestraProgram m_child;
  qFenestraAbilities m_abilities;
  bool m_described = false; ///< and the turntable is asked for
};
