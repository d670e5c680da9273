// Fault injection: runs each request once per possible fault, and reports violated invariants.
// usage: FaultInjection FENESTRA                              all
//        FaultInjection FENESTRA REQUEST RUNS                 RUNS per kind, evenly spaced
//        FaultInjection FENESTRA REQUEST KIND NUMBER [VALUE]  one, to reproduce a violation
// Prints CSV, and violations to standard error. Exit status 1 if there is a violation, 77 if
// processes cannot be traced.
#include "Invariants.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

namespace fenestra::core::faults {
namespace {

constexpr int skipped = 77; ///< exit status of a test that ctest reports as skipped

struct FaultKind {
  Fault::Kind kind;
  const char* word;
  const char* valueName;
  int value;
};

constexpr FaultKind kinds[] = {
    {Fault::Kind::call, "call", "ENOSPC", ENOSPC},
    {Fault::Kind::call, "call", "EIO", EIO},
    {Fault::Kind::call, "call", "EINTR", EINTR},
    {Fault::Kind::call, "call", "EMFILE", EMFILE},
    {Fault::Kind::allocation, "allocation", "", 0},
    {Fault::Kind::signal, "signal", "HUP", SIGHUP},
    {Fault::Kind::signal, "signal", "QUIT", SIGQUIT},
    {Fault::Kind::signal, "signal", "INT", SIGINT},
    {Fault::Kind::signal, "signal", "TERM", SIGTERM},
    {Fault::Kind::signal, "signal", "PIPE", SIGPIPE},
    {Fault::Kind::signal, "signal", "KILL", SIGKILL},
    {Fault::Kind::ignored, "ignored", "HUP", SIGHUP},
    {Fault::Kind::ignored, "ignored", "QUIT", SIGQUIT},
    {Fault::Kind::ignored, "ignored", "INT", SIGINT},
    {Fault::Kind::ignored, "ignored", "TERM", SIGTERM},
    {Fault::Kind::ignored, "ignored", "PIPE", SIGPIPE},
};

struct Case {
  const Baseline* subject;
  const FaultKind* kind;
  long number; ///< of the call, allocation or change at which the fault occurs, from 1
};

struct Result {
  Outcome outcome;
  std::vector<std::string> violations;
};

long countPlaces(const Baseline& subject, const FaultKind& kind) {
  const Outcome& outcome = subject.outcome;
  if (kind.kind == Fault::Kind::call)
    return outcome.calls;
  return kind.kind == Fault::Kind::allocation ? outcome.allocations : outcome.changes;
}

/// Cases for at most `maxCount` places, evenly spaced.
std::vector<Case> makeCases(const Baseline& subject, const FaultKind& kind, long maxCount) {
  std::vector<Case> cases;
  const long places = countPlaces(subject, kind);
  const long count = std::min(places, maxCount);
  for (long i = 0; i < count; ++i)
    cases.push_back({&subject, &kind, 1 + (2 * i + 1) * places / (2 * count)});
  return cases;
}

Result runCase(const Case& testCase, const Workspace& workspace) {
  Result result;
  result.violations =
      checkRun(*testCase.subject, {testCase.kind->kind, testCase.number, testCase.kind->value},
               workspace, result.outcome);
  return result;
}

/// Prints the progress once per minute, since all runs take hours.
class Progress {
public:
  explicit Progress(std::size_t total) : m_total(total) {}

  /// Must be called from a single thread; 0 < `done` <= number of runs.
  void report(std::size_t done) {
    using std::chrono::duration_cast, std::chrono::minutes;
    const Clock::duration elapsed = Clock::now() - m_start;
    if (elapsed < m_next)
      return;
    m_next = elapsed + minutes(1);
    const auto remaining = elapsed * (m_total - done) / done;
    std::fprintf(stderr, "%zu of %zu runs, %lld min left\n", done, m_total,
                 static_cast<long long>(duration_cast<minutes>(remaining).count()));
  }

private:
  using Clock = std::chrono::steady_clock;
  std::size_t m_total;
  Clock::time_point m_start = Clock::now();
  Clock::duration m_next = std::chrono::minutes(1);
};

std::string formatName(const Case& testCase) {
  std::string name = testCase.subject->request->name + " " + testCase.kind->word + " ";
  name += std::to_string(testCase.number);
  return *testCase.kind->valueName ? name + " " + testCase.kind->valueName : name;
}

/// Prints violations immediately, since all runs take hours.
void reportViolations(const Case& testCase, const Result& result) {
  for (const std::string& line : result.violations)
    std::fprintf(stderr, "%s, %s: %s\n", formatName(testCase).c_str(), result.outcome.place.c_str(),
                 line.c_str());
}

std::vector<Result> runAll(const std::vector<Case>& cases, const Tools& tools, unsigned threads) {
  std::vector<Result> results(cases.size());
  std::atomic<std::size_t> next = 0;
  Progress progress(cases.size());
  std::vector<std::thread> workers;
  for (unsigned i = 0; i < threads; ++i)
    workers.emplace_back([&, i] {
      const Workspace workspace(tools);
      for (std::size_t at; (at = next++) < cases.size();) {
        results[at] = runCase(cases[at], workspace);
        reportViolations(cases[at], results[at]);
        if (i == 0)
          progress.report(at + 1);
      }
    });
  for (std::thread& worker : workers)
    worker.join();
  return results;
}

/// Number of occurrences, and where the first occurred.
struct Tally {
  long runs = 0;
  std::string first;

  void add(const std::string& where) {
    if (runs++ == 0)
      first = where;
  }
};

/// Prints crashes after failed allocations, by function.
void printCrashes(const std::map<std::string, Tally>& crashes) {
  for (const auto& [function, tally] : crashes)
    std::fprintf(stderr, "%ld crashes after a failed allocation in %s, first in %s\n", tally.runs,
                 function.c_str(), tally.first.c_str());
}

/// Table row: totals for a request and a kind of fault.
struct Row {
  long places = 0, runs = 0, triggered = 0, statuses[6] = {}, crashes = 0, violations = 0;

  void add(const Result& result) {
    ++runs;
    triggered += result.outcome.place.empty() ? 0 : 1;
    crashes += result.outcome.signal != 0 ? 1 : 0;
    if (result.outcome.status >= 0 && result.outcome.status < 6)
      ++statuses[result.outcome.status];
    violations += result.violations.empty() ? 0 : 1;
  }

  void print(const std::string& request, const std::string& fault) const {
    std::printf("%s,%s,%ld,%ld,%ld,%ld,%ld,%ld,%ld,%ld,%ld,%ld\n", request.c_str(), fault.c_str(),
                places, runs, triggered, statuses[0], statuses[2], statuses[3], statuses[4],
                statuses[5], crashes, violations);
  }
};

/// Prints the results as CSV. True if there is no violation.
bool print(const std::vector<Case>& cases, const std::vector<Result>& results) {
  std::puts("request,fault,places,runs,triggered,exit 0,exit 2,exit 3,exit 4,exit 5,"
            "ended by signal,violations");
  std::map<std::string, Tally> crashes;
  bool passed = true;
  Row row;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& testCase = cases[i];
    const Outcome& outcome = results[i].outcome;
    row.places = countPlaces(*testCase.subject, *testCase.kind);
    row.add(results[i]);
    if (testCase.kind->kind == Fault::Kind::allocation && outcome.signal != 0)
      crashes[findCulprit(outcome.frames).function].add(formatName(testCase));
    passed = passed && results[i].violations.empty();
    const bool isLast = i + 1 == cases.size() || cases[i + 1].subject != testCase.subject ||
                        cases[i + 1].kind != testCase.kind;
    const std::string value = testCase.kind->valueName;
    if (isLast)
      std::exchange(row, {}).print(testCase.subject->request->name,
                                   testCase.kind->word + (value.empty() ? "" : " " + value));
  }
  printCrashes(crashes);
  return passed;
}

/// Case of the arguments REQUEST KIND NUMBER [VALUE]; empty if there is no such case.
std::optional<Case> findCase(const std::vector<Baseline>& subjects, char** words, int count) {
  for (const Baseline& subject : subjects)
    for (const FaultKind& kind : kinds)
      if (subject.request->name == words[0] && std::string_view(kind.word) == words[1] &&
          std::string_view(kind.valueName) == (count > 3 ? words[3] : ""))
        return Case{&subject, &kind, std::atol(words[2])};
  return std::nullopt;
}

int runOne(const Case& testCase, const Tools& tools) {
  const Result result = runCase(testCase, Workspace(tools));
  std::printf("%s: fault at %s; status %d, signal %d\n%s", formatName(testCase).c_str(),
              result.outcome.place.c_str(), result.outcome.status, result.outcome.signal,
              result.outcome.errors.c_str());
  for (const Frame& frame : result.outcome.frames)
    std::printf("  in %s\n", findFunctionName(frame).c_str());
  for (const std::string& line : result.violations)
    std::printf("violation: %s\n", line.c_str());
  return result.violations.empty() ? 0 : 1;
}

int runFaults(int count, char** words) {
  if (count < 2 || count == 3 || count > 6) {
    std::fputs("usage: FaultInjection FENESTRA [REQUEST RUNS | REQUEST KIND NUMBER [VALUE]]\n",
               stderr);
    return 2;
  }
  if (!canTrace()) {
    std::puts("SKIPPED: needs ptrace and seccomp");
    return skipped;
  }
  const Tools tools = {std::filesystem::canonical(words[1]), FENESTRA_PRELOAD, FENESTRA_TEST_DATA};
  std::vector<Baseline> subjects;
  for (const Request& request : requests())
    if (count == 2 || request.name == words[2])
      subjects.push_back(recordBaseline(request, tools));
  if (subjects.empty())
    throw std::runtime_error(std::string(words[2]) + ": no such request");
  if (count > 4) {
    const std::optional<Case> testCase = findCase(subjects, words + 2, count - 2);
    return testCase ? runOne(*testCase, tools) : 2;
  }
  const long maxCount = count == 2 ? std::numeric_limits<long>::max() : std::atol(words[3]);
  std::vector<Case> cases;
  for (const Baseline& subject : subjects)
    for (const FaultKind& kind : kinds) {
      const std::vector<Case> more = makeCases(subject, kind, maxCount);
      cases.insert(cases.end(), more.begin(), more.end());
    }
  // With RUNS it is a short test that runs in parallel with others.
  const unsigned threads = count == 4 ? 1 : std::max(1U, std::thread::hardware_concurrency());
  return print(cases, runAll(cases, tools, threads)) ? 0 : 1;
}

} // namespace
} // namespace fenestra::core::faults

int main(int count, char** words) {
  try {
    return fenestra::core::faults::runFaults(count, words);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "FaultInjection: %s\n", error.what());
    return 1;
  }
}
