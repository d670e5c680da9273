#pragma once
// Private folder for patient data. It is removed with its object; after a crash, the next session
// removes it.

#include <QTemporaryDir>

/// Locks a file in the folder. The system releases the lock however the process ends, so that a
/// folder with a free lock is stale, whichever container or computer its process ran on.
class qFenestraFolder : public QTemporaryDir {
public:
  /// Removes stale folders, then creates "<parent>/<prefix>XXXXXX", accessible to this user only.
  qFenestraFolder(const QString& parent, const QString& prefix);
  ~qFenestraFolder();
  qFenestraFolder(const qFenestraFolder&) = delete;
  qFenestraFolder& operator=(const qFenestraFolder&) = delete;

private:
  int m_lock = -1; ///< file descriptor; -1: none, the folder never counts as stale
};
