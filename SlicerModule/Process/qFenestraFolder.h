#pragma once
// Private folder for patients' files: removed with its object, or after a crash by the next session
// that makes such a folder.

#include <QTemporaryDir>

/// Holds a lock on a file in the folder, which the system frees however this process ends: a folder
/// with a free lock is abandoned, whatever container or computer its process ran in.
class qFenestraFolder : public QTemporaryDir {
public:
  /// Makes "<parent>/<prefix>XXXXXX", readable for this user only. Removes abandoned folders first.
  qFenestraFolder(const QString& parent, const QString& prefix);
  ~qFenestraFolder();
  qFenestraFolder(const qFenestraFolder&) = delete;
  qFenestraFolder& operator=(const qFenestraFolder&) = delete;

private:
  int m_lock = -1; ///< descriptor; -1: none, the folder never counts as abandoned
};
