#pragma once
// Arguments of new processes, and those that start this program again.

#include <string>
#include <vector>

#include <sys/auxv.h>

namespace fenestra::core {

/// Arguments in the form of exec, the program's name first.
class ArgumentList {
public:
  explicit ArgumentList(std::vector<std::string> args) : m_args(std::move(args)) {
    for (std::string& arg : m_args)
      m_pointers.push_back(arg.data());
    m_pointers.push_back(nullptr);
  }
  ArgumentList(const ArgumentList&) = delete;
  ArgumentList& operator=(const ArgumentList&) = delete;

  char* const* get() const { return m_pointers.data(); }

private:
  std::vector<std::string> m_args;
  std::vector<char*> m_pointers; ///< to the elements of m_args, then null
};

/// File to execute: the same build, even if the program's file has been replaced.
inline constexpr const char* selfExecutable = "/proc/self/exe";

/// Arguments of selfExecutable, with `args`. If a loader was started with the program's file, as by
/// the launcher of a release archive, /proc/self/exe is that loader. AT_BASE is then 0, and
/// AT_EXECFN is the program's file (glibc). As in the launcher, --inhibit-cache prevents the loader
/// from using the system's libraries.
inline std::vector<std::string> makeSelfArguments(std::vector<std::string> args) {
  if (::getauxval(AT_BASE) == 0)
    args.insert(args.begin(),
                {"--inhibit-cache", reinterpret_cast<const char*>(::getauxval(AT_EXECFN))});
  args.insert(args.begin(), "fenestra");
  return args;
}

} // namespace fenestra::core
