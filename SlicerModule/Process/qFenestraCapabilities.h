#pragma once
// Abilities of the renderer, queried from the program, so that users see no choice that it refuses.

#include "qFenestraProgram.h"

#include <QMap>

struct qFenestraCapabilities {
  struct Flag {
    QString text;        ///< description
    QStringList choices; ///< all values of a flag with fixed choices
  };
  QMap<QString, Flag> flags; ///< flags of a picture, by name
  QString turntable;         ///< help text of `fenestra turntable`; empty: no such command

  bool hasChoice(const QString& flag, const QString& word) const {
    return flags.value(flag).choices.contains(word);
  }
  bool mentions(const QString& flag, const QString& word) const;
  bool hasTurntable() const { return !turntable.isEmpty(); }

  /// Flags in the description for Slicer (XML); none if it is invalid.
  static QMap<QString, Flag> parseFlags(const QString& description);
};

/// Queries the renderer once. Without an answer, `told` is emitted with empty abilities.
class qFenestraCapabilityQuery : public QObject {
  Q_OBJECT

public:
  explicit qFenestraCapabilityQuery(QObject* parent = nullptr);
  void request(const QString& program);

signals:
  void told(const qFenestraCapabilities& abilities);

private:
  void onEnded(const qFenestraOutcome& outcome);

  QString m_program, m_output;
  qFenestraProgram m_child;
  qFenestraCapabilities m_abilities;
  bool m_flagsKnown = false; ///< the turntable has been queried
};
