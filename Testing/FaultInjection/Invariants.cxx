#include "Invariants.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include <cxxabi.h>

namespace fenestra::core::faults {
namespace {

using Lines = std::vector<std::string>;

/// Exit statuses that are valid for a run with this fault.
std::vector<int> listAllowedStatuses(const Fault& fault) {
  switch (fault.kind) {
  case Fault::Kind::none:
  case Fault::Kind::counting:
  case Fault::Kind::ignored:
    return {0};
  case Fault::Kind::signal:
    return {fault.value == SIGPIPE ? 4 : 5}; // output error, stopped
  default:
    return {0, 2, 3, 4, 5};
  }
}

Lines checkEnd(const Fault& fault, const Outcome& outcome) {
  Lines violations;
  if (outcome.hasTimedOut)
    return {"hangs"};
  const bool isKilled = fault.kind == Fault::Kind::signal && fault.value == SIGKILL;
  const bool isLibraryCrash = fault.kind == Fault::Kind::allocation && outcome.signal != 0 &&
                              !findCulprit(outcome.frames).isFenestra;
  if (isKilled || isLibraryCrash)
    return {};
  const std::vector<int> allowed = listAllowedStatuses(fault);
  if (outcome.signal != 0) {
    violations.push_back("crashes with signal " + std::to_string(outcome.signal));
    if (!outcome.frames.empty())
      violations.back() += " in " + findCulprit(outcome.frames).function;
  } else if (std::find(allowed.begin(), allowed.end(), outcome.status) == allowed.end())
    violations.push_back("status " + std::to_string(outcome.status));
  if (const Lines lines = listErrorLines(outcome); lines.size() > 1)
    violations.push_back(std::to_string(lines.size()) + " error lines");
  return violations;
}

const std::string& findContent(const Files& files, const std::string& name) {
  static const std::string none = "(no such file)";
  const auto found = files.find(name);
  return found == files.end() ? none : found->second;
}

bool areEqual(const Files& files, const Files& expected, const Lines& names) {
  return std::all_of(names.begin(), names.end(), [&](const std::string& name) {
    return findContent(files, name) == findContent(expected, name);
  });
}

Lines findLeftovers(const Baseline& baseline, const Files& files, const Outcome& outcome,
                    const Workspace& workspace) {
  Lines violations;
  const auto isUnfinished = [&](const std::string& name) {
    return outcome.status != 0 && name == baseline.request->leftCheckpoint;
  };
  for (const auto& [name, text] : files)
    if (!isUnfinished(name) && !baseline.before.contains(name) && !baseline.after.contains(name))
      violations.push_back("leaves a temporary file in the folder");
  if (!workspace.tempFiles().empty())
    violations.push_back("leaves files in TMPDIR");
  return violations;
}

/// Violations by partially written files, which equal neither the old nor the new version.
Lines findTornFiles(const Baseline& baseline, const Files& files) {
  Lines violations;
  for (const Lines& group : baseline.request->groups)
    for (const std::string& name : group)
      if (!areEqual(files, baseline.before, {name}) && !areEqual(files, baseline.after, {name}))
        violations.push_back(name + " is neither old nor new");
  const std::string& checkpoint = baseline.request->checkpoint;
  if (!checkpoint.empty() && !areEqual(files, baseline.before, {checkpoint}) &&
      !areEqual(files, baseline.after, {checkpoint}))
    violations.push_back(checkpoint + " is neither old nor new");
  for (const std::string& name : {baseline.request->stats, baseline.request->manifest})
    if (!name.empty() && !nlohmann::json::accept(findContent(files, name)))
      violations.push_back(name + " is not complete JSON");
  return violations;
}

/// Violations by combinations of files: a group or its stats belong to two different requests, or
/// files stay old although the run succeeds (a checkpoint file: without a warning).
Lines findMixedFiles(const Baseline& baseline, const Files& files, const Outcome& outcome) {
  const bool isDone = outcome.status == 0;
  Lines violations;
  bool isAllNew = true, isAnyNew = false;
  for (const Lines& group : baseline.request->groups) {
    const bool isNew = areEqual(files, baseline.after, group);
    isAllNew = isAllNew && isNew;
    isAnyNew = isAnyNew || isNew;
    if (!isNew && !areEqual(files, baseline.before, group))
      violations.push_back("files of one group belong to two requests");
  }
  const std::string& stats = baseline.request->stats;
  const bool isStatsNew = stats.empty() || !areEqual(files, baseline.before, {stats});
  if (!stats.empty() && isStatsNew && !isAnyNew)
    violations.push_back("stats of a request without its images");
  if (isDone && !(isAllNew && isStatsNew))
    violations.push_back("status 0, but not all files are new");
  const std::string& checkpoint = baseline.request->checkpoint;
  const bool isCheckpointNew = checkpoint.empty() || areEqual(files, baseline.after, {checkpoint});
  if (isDone && !isCheckpointNew && outcome.errors.find(checkpoint + ": ") == std::string::npos)
    violations.push_back("status 0 without a new checkpoint or a warning");
  return violations;
}

void append(Lines& lines, const Lines& more) {
  for (const std::string& line : more)
    if (std::find(lines.begin(), lines.end(), line) == lines.end())
      lines.push_back(line);
}

/// Function name without template arguments and parameters.
std::string stripArguments(const std::string& function) {
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

Lines listErrorLines(const Outcome& outcome) {
  Lines lines;
  std::istringstream text(outcome.errors);
  for (std::string line; std::getline(text, line);)
    if (!line.starts_with("fenestra: warning"))
      lines.push_back(line);
  return lines;
}

Lines checkRun(const Baseline& baseline, const Fault& fault, const Workspace& workspace,
               Outcome& outcome) {
  workspace.fill(baseline.before);
  outcome = workspace.run(baseline.request->arguments, fault);
  Lines violations = checkEnd(fault, outcome);
  const Files files = workspace.files();
  append(violations, findTornFiles(baseline, files));
  if (!areEqual(files, baseline.before, baseline.inputs))
    violations.push_back("an input was changed or removed");
  // After a kill or a crash, the next run must succeed and remove the remaining files.
  if (outcome.signal == 0) {
    append(violations, findMixedFiles(baseline, files, outcome));
    append(violations, findLeftovers(baseline, files, outcome, workspace));
  } else {
    const Outcome next = workspace.run(baseline.request->arguments, {});
    if (next.status != 0)
      violations.push_back("the next run ends with status " + std::to_string(next.status));
    append(violations, findMixedFiles(baseline, workspace.files(), next));
    for (const std::string& line : findLeftovers(baseline, workspace.files(), next, workspace))
      violations.push_back(line + ", not removed by the next run");
  }
  return violations;
}

std::string findFunctionName(const Frame& frame) {
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
  char* const demangled = abi::__cxa_demangle(name.c_str(), nullptr, nullptr, &failed);
  if (failed == 0)
    name = demangled;
  std::free(demangled);
  return stripArguments(name);
}

Culprit findCulprit(const std::vector<Frame>& frames) {
  constexpr const char* runtime[] = {"libc.so", "libstdc++", "libgcc_s",
                                     "libm.so", "ld-linux",  "libfaults"};
  std::string
      unnamedModule; // module of a function without a symbol: use its caller in the same module
  for (const Frame& frame : frames) {
    const std::string module = std::filesystem::path(frame.module).filename().string();
    const bool isRuntime =
        std::any_of(std::begin(runtime), std::end(runtime),
                    [&module](const char* name) { return module.starts_with(name); });
    const std::string function = findFunctionName(frame);
    if (isRuntime || function.starts_with("std::") || function.starts_with("__"))
      continue;
    if (!unnamedModule.empty() && module != unnamedModule)
      break;
    unnamedModule = module;
    if (function != "??")
      return {function + " (" + module + ")",
              function.find("fenestra::core::") != std::string::npos || function == "main"};
  }
  return {"unknown function (" + unnamedModule + ")", unnamedModule.empty()};
}

} // namespace fenestra::core::faults
