#pragma once
// Abilities of the renderer, queried from the program, so that users see no choice that it refuses.

#include "qFenestraProgram.h"

#include <QMap>

struct qFenestraAbilities {
  struct Flag {
    QString text;      ///< description
    QStringList words; ///< all values of a flag with fixed choices
  };
  QMap<QString, Flag> flags; ///< flags of a picture, by name
  QString turntable;         ///< help text of `fenestra turntable`; empty: no such command

  bool takes(const QString& flag, const QString& word) const {
    return flags.value(flag).words.contains(word);
  }
  bool names(const QString& flag, const QString& word) const;
  bool turns() const { return !turntable.isEmpty(); }

  /// Flags in the description for Slicer (XML); none if it is invalid.
  static QMap<QString, Flag> flagsIn(const QString& description);
};

/// Queries the renderer once. Without an answer, `told` is emitted with empty abilities.
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
  bool m_described = false; ///< the turntable has been queried
};
