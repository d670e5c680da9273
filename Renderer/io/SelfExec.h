#pragma once
// Arguments that start this program again in a new process.

#include <string>
#include <vector>

#include <sys/auxv.h>

namespace fenestra::core {

/// File to execute: the same build, even if the program's file has been replaced.
inline constexpr const char* selfExecutable = "/proc/self/exe";

/// Argument list of this program with `args`. If a loader was started with the program's file, as
/// by the launcher of a release archive, /proc/self/exe is that loader. AT_BASE is then 0, and
/// AT_EXECFN is the program's file (glibc). As in the launcher, --inhibit-cache prevents the loader
/// from using the system's libraries.
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
  std::vector<char*> m_pointers; ///< to the elements of m_args, then null
};

} // namespace fenestra::core
