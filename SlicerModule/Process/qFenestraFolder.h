#pragma once
// A private folder for files of patients: it goes with its object, and after a crash with the next
// session that makes one.

#include <QTemporaryDir>

/// Holds a lock on a file in the folder, which the system frees however this process ends. So a
/// folder whose lock is free is abandoned, whatever container or computer its process ran in.
class qFenestraFolder : public QTemporaryDir {
public:
  /// "<parent>/<prefix>XXXXXX", readable for this user alone. Removes abandoned ones first.
  qFenestraFolder(const QString& parent, const QString& prefix);
  ~qFenestraFolder();
  qFenestraFolder(const qFenestraFolder&) = delete;
  qFenestraFolder& operator=(const qFenestraFolder&) = delete;

private:
  int m_lock = -1; ///< descriptor; -1: none, and the folder is never taken for abandoned
};
