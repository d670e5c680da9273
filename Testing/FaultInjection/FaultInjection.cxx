// Injects every fault in turn into a request's runs, and reports the consequences.
// usage: Faults FENESTRA [RUNS]                            all, or RUNS of each kind, evenly spread
//        Faults FENESTRA REQUEST KIND NUMBER [VALUE]       one, to reproduce a violation
// Prints tables in Markdown. Exit status 1 if a run violates an invariant, 77 if processes cannot
// be traced here.
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
#include <thread>
#include <utility>

namespace fenestra::faults {
namespace {

constexpr int skipped = 77; ///< exit status by which ctest reports a skipped test

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
  long number;
};

struct Result {
  Outcome outcome;
  std::vector<std::string> violations;
};

long countPlaces(const Baseline& subject, const FaultKind& kind) {
  const Outcome& outcome = subject.outcome;
  if (kind.kind == Fault::Kind::call)
    return outcome.calls;
  return kind.kind == Fault::Kind::allocation ? outcome.allocations : outcome.commits;
}

/// Cases for all places, or for `most` places evenly spread.
std::vector<Case> makeCases(const Baseline& subject, const FaultKind& kind, long maxCount) {
  std::vector<Case> cases;
  const long places = countPlaces(subject, kind);
  const long count = std::min(places, maxCount);
  for (long i = 0; i < count; ++i)
    cases.push_back({&subject, &kind, 1 + (2 * i + 1) * places / (2 * count)});
  return cases;
}

Result runCase(const Case& testCase, const Workspace& place) {
  Result result;
  result.violations =
      checkRun(*testCase.subject, {testCase.kind->kind, testCase.number, testCase.kind->value},
               place, result.outcome);
  return result;
}

/// Reports progress every minute, since a run takes hours.
class Progress {
public:
  explicit Progress(std::size_t total) : m_total(total) {}

  /// Called from one thread; 0 < `done` <= whole.
  void report(std::size_t done) {
    using std::chrono::duration_cast, std::chrono::minutes;
    const Clock::duration spent = Clock::now() - m_start;
    if (spent < m_next)
      return;
    m_next = spent + minutes(1);
    const auto left = spent * (m_total - done) / done;
    std::fprintf(stderr, "%zu of %zu runs, %lld min left\n", done, m_total,
                 static_cast<long long>(duration_cast<minutes>(left).count()));
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

/// Reports violations at once: a run takes hours.
void reportViolations(const Case& testCase, const Result& result) {
  for (const std::string& line : result.violations)
    std::fprintf(stderr, "%s: %s\n", formatName(testCase).c_str(), line.c_str());
}

std::vector<Result> runAll(const std::vector<Case>& cases, const Tools& tools, unsigned threads) {
  std::vector<Result> results(cases.size());
  std::atomic<std::size_t> next = 0;
  Progress progress(cases.size());
  std::vector<std::thread> workers;
  for (unsigned i = 0; i < threads; ++i)
    workers.emplace_back([&, i] {
      const Workspace place(tools);
      for (std::size_t at; (at = next++) < cases.size();) {
        results[at] = runCase(cases[at], place);
        reportViolations(cases[at], results[at]);
        if (i == 0)
          progress.report(at + 1);
      }
    });
  for (std::thread& worker : workers)
    worker.join();
  return results;
}

/// Number of occurrences, and the place of the first.
struct Tally {
  long runs = 0;
  std::string first;

  void add(const std::string& where) {
    if (runs++ == 0)
      first = where;
  }
};

void printTallies(const char* title, const char* what,
                  const std::map<std::string, Tally>& tallies) {
  std::printf("\n## %s\n\n", title);
  if (tallies.empty()) {
    std::puts("None.");
    return;
  }
  std::printf("| %s | runs | first |\n|---|---|---|\n", what);
  for (const auto& [text, tally] : tallies)
    std::printf("| %s | %ld | %s |\n", text.c_str(), tally.runs, tally.first.c_str());
}

/// Totals for a request and a kind of fault, in the order of the tables' columns.
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
    std::printf("| %s | %s | %ld | %ld | %ld | %ld | %ld | %ld | %ld | %ld | %ld | %ld |\n",
                request.c_str(), fault.c_str(), places, runs, triggered, statuses[0], statuses[2],
                statuses[3], statuses[4], statuses[5], crashes, violations);
  }
};

/// Prints the tables; returns true if there is no violation.
bool print(const std::vector<Case>& cases, const std::vector<Result>& results) {
  std::puts("# Faults, in turn\n\n"
            "| request | fault | places | runs | met it | ended 0 | 2 | 3 | 4 | 5 | by a signal | "
            "wrong |\n|---|---|---|---|---|---|---|---|---|---|---|---|");
  std::map<std::string, Tally> crashes, violations;
  Row row;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& testCase = cases[i];
    const auto& [outcome, wrong] = results[i];
    row.places = countPlaces(*testCase.subject, *testCase.kind);
    row.add(results[i]);
    if (testCase.kind->kind == Fault::Kind::allocation && outcome.signal != 0)
      crashes[findCulprit(outcome.frames).function].add(formatName(testCase));
    const std::string call = outcome.place.substr(0, outcome.place.find(' '));
    for (const std::string& line : wrong)
      violations[testCase.subject->request->name + ", " + testCase.kind->word + " at " + call +
                 ": " + line]
          .add(formatName(testCase) + ": " + outcome.place);
    const bool isLast = i + 1 == cases.size() || cases[i + 1].subject != testCase.subject ||
                        cases[i + 1].kind != testCase.kind;
    if (isLast)
      std::exchange(row, {}).print(testCase.subject->request->name,
                                   std::string(testCase.kind->word) + " " +
                                       testCase.kind->valueName);
  }
  printTallies("Deaths where an allocation fails, by function", "innermost function", crashes);
  printTallies("Violations", "what", violations);
  return violations.empty();
}

/// Case given by the words REQUEST KIND NUMBER [VALUE].
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
  std::printf("%s: met %s; status %d, signal %d\n%s", formatName(testCase).c_str(),
              result.outcome.place.c_str(), result.outcome.status, result.outcome.signal,
              result.outcome.errors.c_str());
  for (const Frame& frame : result.outcome.frames)
    std::printf("  in %s\n", functionName(frame).c_str());
  for (const std::string& line : result.violations)
    std::printf("wrong: %s\n", line.c_str());
  return result.violations.empty() ? 0 : 1;
}

int runFaults(int count, char** words) {
  if (count != 2 && count != 3 && count != 5 && count != 6) {
    std::fputs("usage: Faults FENESTRA [RUNS | REQUEST KIND NUMBER [VALUE]]\n", stderr);
    return 2;
  }
  if (!canTrace()) {
    std::puts("SKIPPED: this process may not trace others (ptrace, seccomp)");
    return skipped;
  }
  const Tools tools = {std::filesystem::canonical(words[1]), FENESTRA_PRELOAD, FENESTRA_TEST_DATA};
  std::vector<Baseline> subjects;
  for (const Request& request : requests())
    subjects.push_back(recordBaseline(request, tools));
  if (count > 3) {
    const std::optional<Case> testCase = findCase(subjects, words + 2, count - 2);
    return testCase ? runOne(*testCase, tools) : 2;
  }
  const long maxCount = count == 3 ? std::atol(words[2]) : std::numeric_limits<long>::max();
  std::vector<Case> cases;
  for (const Baseline& subject : subjects)
    for (const FaultKind& kind : kinds) {
      const std::vector<Case> more = makeCases(subject, kind, maxCount);
      cases.insert(cases.end(), more.begin(), more.end());
    }
  // A sample of faults runs as a test, beside other tests.
  const unsigned threads = count == 3 ? 1 : std::max(1U, std::thread::hardware_concurrency());
  return print(cases, runAll(cases, tools, threads)) ? 0 : 1;
}

} // namespace
} // namespace fenestra::faults

int main(int count, char** words) {
  try {
    return fenestra::faults::runFaults(count, words);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "Faults: %s\n", error.what());
    return 1;
  }
}
