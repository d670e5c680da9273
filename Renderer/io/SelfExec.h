#pragma once
// This program, to be run once more in a process of its own.

#include <string>
#include <vector>

#include <sys/auxv.h>

namespace fenestra {

/// File to run: the same build, even if the program's file has been replaced.
inline constexpr const char* selfExecutable = "/proc/self/exe";

/// Arguments with which it is this program with `words`. Where a loader was called with the
/// program's file (an archive brings its own), /proc/self/exe is that loader: the kernel has no
/// base of an interpreter then, and the loader says the file (glibc: AT_EXECFN). It is told again
/// to keep away from the system's libraries, as the archive's launcher tells it.
class SelfArguments {
public:
  explicit SelfArguments(std::vector<std::string> args) : m_args(std::move(args)) {
    if (::getauxval(AT_BASE) == 0)
      m_args.insert(m_args.begin(),
                    {"--inhibit-cache", reinterpret_cast<const char*>(::getauxval(AT_EXECFN))});
    m_args.insert(m_args.begin(), "fenestra");
    for (std::string& arg : m_args)
      m_pointers.push_back(arg.data());
    m_pointers.push_back(nullptr);
  }
  SelfArguments(const SelfArguments&) = delete;
  SelfArguments& operator=(const SelfArguments&) = delete;

  char* const* get() const { return m_pointers.data(); }

private:
  std::vector<std::string> m_args;
  std::vector<char*> m_pointers; ///< into m_words, and a null
};

} // namespace fenestra
