#include "base/safe/MadeFolders.h"

#include "base/safe/SystemCalls.h"

#include <sys/stat.h>

namespace fenestra {

static constexpr const char* otherFolder = "name a folder that you may write to";

MadeFolders::MadeFolders(const std::filesystem::path& folder) {
  std::error_code failed;
  const std::filesystem::path absolute = std::filesystem::absolute(folder, failed);
  if (failed)
    throw makingError(folder, failed.value(), otherFolder);
  make(absolute.lexically_normal());
}

MadeFolders::~MadeFolders() {
  while (!m_made.empty()) { // the innermost first
    std::error_code failed;
    if (!std::filesystem::is_empty(m_made.back()->path(), failed) && !failed)
      m_made.back()->keep();
    m_made.pop_back();
  }
}

void MadeFolders::make(const std::filesystem::path& folder) {
  std::error_code failed;
  if (std::filesystem::is_directory(folder, failed))
    return;
  make(folder.parent_path());
  if (!folder.has_filename()) // `folder` ends in a slash
    return;
  const Uninterrupted making;
  m_made.push_back(std::make_unique<Leftover>(folder, Leftover::Kind::folder));
  if (::mkdir(folder.c_str(), 0777) == 0)
    return;
  const int code = errno;
  m_made.back()->keep(); // the existing name is not ours
  throw makingError(folder, code, otherFolder);
}

} // namespace fenestra
