#pragma once
// Capabilities of the renderer, queried from the program. The panel offers only these.

#include "qFenestraProgram.h"

#include <QMap>

struct qFenestraCapabilities {
  struct Flag {
    QString text;        ///< description
    QStringList choices; ///< all values of a flag with fixed choices
  };
  QMap<QString, Flag> flags; ///< of `fenestra render`, by name
  QString turntable;         ///< help text of `fenestra turntable`; empty: no such command

  bool hasChoice(const QString& flag, const QString& word) const {
    return flags.value(flag).choices.contains(word);
  }
  bool mentions(const QString& flag, const QString& word) const;
  bool hasTurntable() const { return !turntable.isEmpty(); }

  /// Parses the renderer's description for Slicer (XML); no flags if it is invalid.
  static QMap<QString, Flag> parseFlags(const QString& description);
};

/// Queries the renderer once. After a failure, `received` is emitted without capabilities.
class qFenestraCapabilityQuery : public QObject {
  Q_OBJECT

public:
  explicit qFenestraCapabilityQuery(QObject* parent = nullptr);
  void request(const QString& program);

signals:
  void received(const qFenestraCapabilities& capabilities);

private:
  void onEnded(const qFenestraOutcome& outcome);

  QString m_program, m_output;
  qFenestraProgram m_child;
  qFenestraCapabilities m_capabilities;
  bool m_flagsKnown = false; ///< the query of the turntable runs
};
