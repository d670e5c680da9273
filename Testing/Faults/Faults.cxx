// Injects every fault in turn into a request's runs, and reports the consequences.
// usage: Faults FENESTRA [RUNS]                            all, or RUNS of each kind, evenly spread
//        Faults FENESTRA REQUEST KIND NUMBER [VALUE]       one, to reproduce a violation
// Prints tables in Markdown. Exit status 1 if a run violates an invariant, 77 if processes cannot
// be traced here.
#include "Judge.h"

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

struct KindOfFault {
  Fault::Kind kind;
  const char* word;
  const char* valueName;
  int value;
};

constexpr KindOfFault kinds[] = {
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
  const Subject* subject;
  const KindOfFault* kind;
  long number;
};

struct Result {
  Outcome outcome;
  std::vector<std::string> wrong;
};

long placesOf(const Subject& subject, const KindOfFault& kind) {
  const Outcome& outcome = subject.undisturbed;
  if (kind.kind == Fault::Kind::call)
    return outcome.calls;
  return kind.kind == Fault::Kind::allocation ? outcome.allocations : outcome.commits;
}

/// Cases for all places, or for `most` places evenly spread.
std::vector<Case> casesOf(const Subject& subject, const KindOfFault& kind, long most) {
  std::vector<Case> cases;
  const long places = placesOf(subject, kind);
  const long count = std::min(places, most);
  for (long i = 0; i < count; ++i)
    cases.push_back({&subject, &kind, 1 + (2 * i + 1) * places / (2 * count)});
  return cases;
}

Result resultOf(const Case& one, const Place& place) {
  Result result;
  result.wrong =
      judge(*one.subject, {one.kind->kind, one.number, one.kind->value}, place, result.outcome);
  return result;
}

/// Reports progress every minute, since a run takes hours.
class Progress {
public:
  explicit Progress(std::size_t whole) : m_whole(whole) {}

  /// Called from one thread; 0 < `done` <= whole.
  void tell(std::size_t done) {
    using std::chrono::duration_cast, std::chrono::minutes;
    const Clock::duration spent = Clock::now() - m_start;
    if (spent < m_next)
      return;
    m_next = spent + minutes(1);
    const auto left = spent * (m_whole - done) / done;
    std::fprintf(stderr, "%zu of %zu runs, %lld min left\n", done, m_whole,
                 static_cast<long long>(duration_cast<minutes>(left).count()));
  }

private:
  using Clock = std::chrono::steady_clock;
  std::size_t m_whole;
  Clock::time_point m_start = Clock::now();
  Clock::duration m_next = std::chrono::minutes(1);
};

std::string nameOf(const Case& one) {
  std::string name = one.subject->request->name + " " + one.kind->word + " ";
  name += std::to_string(one.number);
  return *one.kind->valueName ? name + " " + one.kind->valueName : name;
}

/// Reports violations at once: a run takes hours.
void tellWrong(const Case& one, const Result& result) {
  for (const std::string& line : result.wrong)
    std::fprintf(stderr, "%s: %s\n", nameOf(one).c_str(), line.c_str());
}

std::vector<Result> runAll(const std::vector<Case>& cases, const Tools& tools, unsigned threads) {
  std::vector<Result> results(cases.size());
  std::atomic<std::size_t> next = 0;
  Progress progress(cases.size());
  std::vector<std::thread> workers;
  for (unsigned i = 0; i < threads; ++i)
    workers.emplace_back([&, i] {
      const Place place(tools);
      for (std::size_t at; (at = next++) < cases.size();) {
        results[at] = resultOf(cases[at], place);
        tellWrong(cases[at], results[at]);
        if (i == 0)
          progress.tell(at + 1);
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
  long places = 0, runs = 0, met = 0, ends[6] = {}, deaths = 0, wrong = 0;

  void add(const Result& result) {
    ++runs;
    met += result.outcome.place.empty() ? 0 : 1;
    deaths += result.outcome.signal != 0 ? 1 : 0;
    if (result.outcome.status >= 0 && result.outcome.status < 6)
      ++ends[result.outcome.status];
    wrong += result.wrong.empty() ? 0 : 1;
  }

  void print(const std::string& request, const std::string& fault) const {
    std::printf("| %s | %s | %ld | %ld | %ld | %ld | %ld | %ld | %ld | %ld | %ld | %ld |\n",
                request.c_str(), fault.c_str(), places, runs, met, ends[0], ends[2], ends[3],
                ends[4], ends[5], deaths, wrong);
  }
};

/// Prints the tables; returns true if there is no violation.
bool print(const std::vector<Case>& cases, const std::vector<Result>& results) {
  std::puts("# Faults, in turn\n\n"
            "| request | fault | places | runs | met it | ended 0 | 2 | 3 | 4 | 5 | by a signal | "
            "wrong |\n|---|---|---|---|---|---|---|---|---|---|---|---|");
  std::map<std::string, Tally> deaths, violations;
  Row row;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& one = cases[i];
    const auto& [outcome, wrong] = results[i];
    row.places = placesOf(*one.subject, *one.kind);
    row.add(results[i]);
    if (one.kind->kind == Fault::Kind::allocation && outcome.signal != 0)
      deaths[culprit(outcome.frames).function].add(nameOf(one));
    const std::string call = outcome.place.substr(0, outcome.place.find(' '));
    for (const std::string& line : wrong)
      violations[one.subject->request->name + ", " + one.kind->word + " at " + call + ": " + line]
          .add(nameOf(one) + ": " + outcome.place);
    const bool isLast = i + 1 == cases.size() || cases[i + 1].subject != one.subject ||
                        cases[i + 1].kind != one.kind;
    if (isLast)
      std::exchange(row, {}).print(one.subject->request->name,
                                   std::string(one.kind->word) + " " + one.kind->valueName);
  }
  printTallies("Deaths where an allocation fails, by function", "innermost function", deaths);
  printTallies("Violations", "what", violations);
  return violations.empty();
}

/// Case given by the words REQUEST KIND NUMBER [VALUE].
std::optional<Case> caseOf(const std::vector<Subject>& subjects, char** words, int count) {
  for (const Subject& subject : subjects)
    for (const KindOfFault& kind : kinds)
      if (subject.request->name == words[0] && std::string_view(kind.word) == words[1] &&
          std::string_view(kind.valueName) == (count > 3 ? words[3] : ""))
        return Case{&subject, &kind, std::atol(words[2])};
  return std::nullopt;
}

int showOne(const Case& one, const Tools& tools) {
  const Result result = resultOf(one, Place(tools));
  std::printf("%s: met %s; status %d, signal %d\n%s", nameOf(one).c_str(),
              result.outcome.place.c_str(), result.outcome.status, result.outcome.signal,
              result.outcome.errors.c_str());
  for (const Frame& frame : result.outcome.frames)
    std::printf("  in %s\n", functionOf(frame).c_str());
  for (const std::string& line : result.wrong)
    std::printf("wrong: %s\n", line.c_str());
  return result.wrong.empty() ? 0 : 1;
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
  std::vector<Subject> subjects;
  for (const Request& request : requests())
    subjects.push_back(learn(request, tools));
  if (count > 3) {
    const std::optional<Case> one = caseOf(subjects, words + 2, count - 2);
    return one ? showOne(*one, tools) : 2;
  }
  const long most = count == 3 ? std::atol(words[2]) : std::numeric_limits<long>::max();
  std::vector<Case> cases;
  for (const Subject& subject : subjects)
    for (const KindOfFault& kind : kinds) {
      const std::vector<Case> more = casesOf(subject, kind, most);
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
