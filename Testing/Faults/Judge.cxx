#include "Judge.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include <cxxabi.h>

namespace fenestra::faults {
namespace {

using Lines = std::vector<std::string>;

/// Exit statuses allowed for a run with the fault.
std::vector<int> allowedStatuses(const Fault& fault) {
  switch (fault.kind) {
  case Fault::Kind::none:
  case Fault::Kind::counting:
  case Fault::Kind::ignored:
    return {0};
  case Fault::Kind::signal:
    return {fault.value == SIGPIPE ? 4 : 5};
  default:
    return {0, 2, 3, 4, 5};
  }
}

Lines wrongEnd(const Fault& fault, const Outcome& outcome) {
  Lines wrong;
  if (outcome.hung)
    return {"hangs"};
  const bool isKilled = fault.kind == Fault::Kind::signal && fault.value == SIGKILL;
  const bool isDeath = fault.kind == Fault::Kind::allocation && outcome.signal != 0 &&
                       !culprit(outcome.frames).isOurs;
  if (isKilled || isDeath)
    return {};
  const std::vector<int> allowed = allowedStatuses(fault);
  if (outcome.signal != 0) {
    wrong.push_back("dies of signal " + std::to_string(outcome.signal));
    if (!outcome.frames.empty())
      wrong.back() += " in " + culprit(outcome.frames).function;
  } else if (std::find(allowed.begin(), allowed.end(), outcome.status) == allowed.end())
    wrong.push_back("status " + std::to_string(outcome.status));
  if (const Lines lines = errorLines(outcome); lines.size() > 1)
    wrong.push_back(std::to_string(lines.size()) + " lines");
  return wrong;
}

const std::string& content(const Files& files, const std::string& name) {
  static const std::string none = "(no such file)";
  const auto found = files.find(name);
  return found == files.end() ? none : found->second;
}

bool areAs(const Files& files, const Files& wanted, const Lines& names) {
  return std::all_of(names.begin(), names.end(), [&](const std::string& name) {
    return content(files, name) == content(wanted, name);
  });
}

Lines leftovers(const Subject& subject, const Files& files, const Outcome& outcome,
                const Place& place) {
  Lines wrong;
  const auto isUnfinished = [&](const std::string& name) {
    return outcome.status != 0 && name == subject.request->unfinished;
  };
  for (const auto& [name, text] : files)
    if (!isUnfinished(name) && !subject.before.contains(name) && !subject.after.contains(name))
      wrong.push_back("leaves a file in the folder");
  if (!place.temporaries().empty())
    wrong.push_back("leaves files in TMPDIR");
  return wrong;
}

/// Violations: files that are neither old nor new, torn in the middle of a write.
Lines tornFiles(const Subject& subject, const Files& files) {
  Lines wrong;
  for (const Lines& group : subject.request->groups)
    for (const std::string& name : group)
      if (!areAs(files, subject.before, {name}) && !areAs(files, subject.after, {name}))
        wrong.push_back(name + " is neither old nor new");
  const std::string& film = subject.request->film;
  if (!film.empty() && !areAs(files, subject.before, {film}) &&
      !areAs(files, subject.after, {film}))
    wrong.push_back(film + " is neither old nor new");
  for (const std::string& name : {subject.request->stats, subject.request->record})
    if (!name.empty() && !nlohmann::json::accept(content(files, name)))
      wrong.push_back(name + " is not whole");
  return wrong;
}

/// Violations: groups whose files stem from two requests, or whose stats are of another request; a
/// film that stayed old without a warning.
Lines mixedFiles(const Subject& subject, const Files& files, const Outcome& outcome) {
  const bool isDone = outcome.status == 0;
  Lines wrong;
  bool allNew = true, anyNew = false;
  for (const Lines& group : subject.request->groups) {
    const bool isNew = areAs(files, subject.after, group);
    allNew = allNew && isNew;
    anyNew = anyNew || isNew;
    if (!isNew && !areAs(files, subject.before, group))
      wrong.push_back("files of two requests beside each other");
  }
  const std::string& stats = subject.request->stats;
  const bool statsNew = stats.empty() || !areAs(files, subject.before, {stats});
  if (!stats.empty() && statsNew && !anyNew)
    wrong.push_back("stats of a request whose pictures are not there");
  if (isDone && !(allNew && statsNew))
    wrong.push_back("status 0 without all files");
  const std::string& film = subject.request->film;
  const bool isFilmNew = film.empty() || areAs(files, subject.after, {film});
  if (isDone && !isFilmNew && outcome.errors.find(film + ": ") == std::string::npos)
    wrong.push_back("status 0 without a film, and without a warning");
  return wrong;
}

void append(Lines& lines, const Lines& more) {
  for (const std::string& line : more)
    if (std::find(lines.begin(), lines.end(), line) == lines.end())
      lines.push_back(line);
}

/// Function name without template arguments and parameters.
std::string withoutArguments(const std::string& function) {
  std::string name;
  int depth = 0;
  for (const char c : function) {
    depth -= c == '>' ? 1 : 0;
    if (depth == 0 && c == '(' && !name.empty() && name.back() != ':')
      break;
    if (depth == 0 && c != '<' && c != '>')
      name += c;
    depth += c == '<' ? 1 : 0;
  }
  return name;
}

} // namespace

Lines errorLines(const Outcome& outcome) {
  Lines lines;
  std::istringstream text(outcome.errors);
  for (std::string line; std::getline(text, line);)
    if (!line.starts_with("fenestra: warning"))
      lines.push_back(line);
  return lines;
}

Lines judge(const Subject& subject, const Fault& fault, const Place& place, Outcome& outcome) {
  place.fill(subject.before);
  outcome = place.run(subject.request->words, fault);
  Lines wrong = wrongEnd(fault, outcome);
  const Files files = place.files();
  append(wrong, tornFiles(subject, files));
  if (!areAs(files, subject.before, subject.inputs))
    wrong.push_back("an input is changed or gone");
  // Leftovers of a kill, or of a death outside our code, must be gone after the next run.
  if (outcome.signal == 0) {
    append(wrong, mixedFiles(subject, files, outcome));
    append(wrong, leftovers(subject, files, outcome, place));
  } else {
    const Outcome next = place.run(subject.request->words, {});
    if (next.status != 0)
      wrong.push_back("the next run ends with " + std::to_string(next.status));
    append(wrong, mixedFiles(subject, place.files(), next));
    for (const std::string& line : leftovers(subject, place.files(), next, place))
      wrong.push_back(line + " that the next run does not remove");
  }
  return wrong;
}

std::string functionOf(const Frame& frame) {
  std::string name = frame.function;
  if (name.empty()) {
    std::ostringstream command;
    command << "addr2line -f -e '" << frame.module << "' 0x" << std::hex << frame.address - 1;
    if (FILE* const pipe = ::popen(command.str().c_str(), "r")) {
      char line[2000] = {};
      if (std::fgets(line, sizeof line, pipe))
        name = std::string(line, std::strcspn(line, "\n"));
      ::pclose(pipe);
    }
  }
  int failed = 0;
  char* const readable = abi::__cxa_demangle(name.c_str(), nullptr, nullptr, &failed);
  if (failed == 0)
    name = readable;
  std::free(readable);
  return withoutArguments(name);
}

Culprit culprit(const std::vector<Frame>& frames) {
  constexpr const char* runtime[] = {"libc.so", "libstdc++", "libgcc_s",
                                     "libm.so", "ld-linux",  "libfaults"};
  std::string nameless; // module of a nameless function: its caller there may have a name
  for (const Frame& frame : frames) {
    const std::string module = std::filesystem::path(frame.module).filename().string();
    const bool isRuntime =
        std::any_of(std::begin(runtime), std::end(runtime),
                    [&module](const char* name) { return module.starts_with(name); });
    const std::string function = functionOf(frame);
    if (isRuntime || function.starts_with("std::") || function.starts_with("__"))
      continue;
    if (!nameless.empty() && module != nameless)
      break;
    nameless = module;
    if (function != "??")
      return {function + " (" + module + ")",
              function.find("fenestra::") != std::string::npos || function == "main"};
  }
  return {"a function without a name (" + nameless + ")", nameless.empty()};
}

} // namespace fenestra::faults
