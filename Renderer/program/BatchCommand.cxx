// `fenestra batch`: renders each row of a table in a process of its own. The result of a row is bit
// for bit that of `fenestra render`, and a crash costs one row.

#include "base/Error.h"
#include "io/MessageText.h"
#include "io/platform/ChildProcess.h"
#include "io/platform/SharedSlot.h"
#include "program/BatchResults.h"
#include "program/CommandLine.h"
#include "program/Commands.h"
#include "program/ErrorAdvice.h"
#include "program/Messages.h"
#include "program/ProgressView.h"
#include "program/Stop.h"
#include "program/UsageError.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <thread>

namespace fenestra::core {
namespace {

namespace fs = std::filesystem;
using State = RowOutcome::State;

/// Shard of the rows, as --rows K/N; `index` counts from 0.
struct RowShard {
  std::size_t index = 0, count = 1;

  bool has(std::size_t row) const { return row % count == index; }
};

struct BatchOptions {
  std::vector<std::string> formats; ///< in addition to .png
  int workers = 1;
  int threads = 1; ///< total of all workers
  RowShard shard;
  bool restart = false;
  ProgressMode progress = ProgressMode::automatic;
  bool quiet = false, verbose = false;
};

/// Renders the unfinished rows, several at a time.
class Batch {
public:
  Batch(const BatchOptions& options, BatchResults& results)
      : m_options(options),
        m_results(results),
        m_view(options.progress, "Batch"),
        m_workers(static_cast<std::size_t>(options.workers)) {
    for (std::size_t row = 0; row < results.rows.size(); ++row)
      if (options.shard.has(row))
        m_rows.push_back(row);
  }

  /// Returns when all rows have ended, or those under way after a request to stop.
  void run() {
    const DeferredStop stopInstead(m_stop);
    while (hasWork()) {
      for (std::size_t i = 0; i < m_workers.size(); ++i) {
        if (m_workers[i] && m_workers[i]->child.hasEnded())
          finishWorker(i);
        while (!m_workers[i] && m_next < m_rows.size() && !m_stop)
          beginRow(m_rows[m_next++], i);
      }
      if (m_stop)
        requestStop();
      m_view.show(fraction(), statusFields(), false);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    m_view.show(m_stop ? fraction() : 1.0, statusFields(), true);
  }

  std::size_t rows() const { return m_rows.size(); }
  std::size_t rendered() const { return m_rendered; }
  std::size_t failed() const { return m_results.count(State::failed); }
  bool isStopped() const { return m_stop; }

private:
  /// Process that is rendering a row.
  struct Worker {
    std::size_t row;
    std::unique_ptr<RowManifest> manifest;
    ChildProcess child;
    Stopwatch watch = {};
  };

  bool hasWork() const {
    return (m_next < m_rows.size() && !m_stop) ||
           std::ranges::any_of(m_workers, [](const auto& worker) { return worker != nullptr; });
  }

  /// Threads of a worker; the total is divided evenly.
  int countThreads(std::size_t worker) const {
    const int share = m_options.threads / m_options.workers;
    const int rest = m_options.threads % m_options.workers;
    return std::max(1, share + (static_cast<int>(worker) < rest ? 1 : 0));
  }

  void beginRow(std::size_t row, std::size_t worker) {
    try {
      auto manifest = std::make_unique<RowManifest>(m_results.rows[row], m_results.folder,
                                                    m_options.formats, m_options.restart);
      if (manifest->finished()) {
        ++m_skipped;
        m_results.outcomes[row] = *manifest->finished();
        if (m_options.verbose)
          printLine(concat(m_results.rows[row].name, ": ",
                           toString(m_results.outcomes[row].seconds, 3), " s, rendered before"));
        return;
      }
      manifest->begin();
      startWorker(row, std::move(manifest), worker);
    } catch (const Error& error) {
      reportOutcome(
          row, {State::failed, exitStatus(error.kind()), 0.0, composeMessage(error.message())});
    }
  }

  /// Throws Error (output).
  void startWorker(std::size_t row, std::unique_ptr<RowManifest> manifest, std::size_t worker) {
    auto arguments = manifest->arguments(countThreads(worker));
    m_workers[worker].reset(
        new Worker{row, std::move(manifest),
                   ChildProcess(std::move(arguments), exitStatus(ErrorKind::output),
                                &m_smoothedVolume.file())});
  }

  void finishWorker(std::size_t index) {
    const std::unique_ptr<Worker> worker = std::move(m_workers[index]);
    const ChildProcess& child = worker->child;
    RowOutcome outcome{State::done, child.status(), worker->watch.seconds()};
    const bool wasStarting = // had no signal handler yet
        m_hasRequestedStop && outcome.status == 128 + SIGTERM;
    if (wasStarting || outcome.status == stoppedStatus) {
      outcome.state = State::stopped;
      outcome.status = stoppedStatus;
    } else if (outcome.status != 0) {
      outcome.state = State::failed;
      outcome.error = findErrorLine(child);
    }
    try {
      if (!m_stop && worker->manifest->discardCheckpoint(outcome))
        return startWorker(worker->row, std::move(worker->manifest), index);
      worker->manifest->finish(outcome);
    } catch (const Error& error) {
      outcome = {State::failed, exitStatus(error.kind()), outcome.seconds,
                 composeMessage(error.message())};
    }
    reportOutcome(worker->row, outcome);
  }

  /// Last error message of the process, ignoring warnings.
  static std::string findErrorLine(const ChildProcess& child) {
    if (child.status() > 128)
      return concat("ended by signal ", child.status() - 128, " (",
                    ::strsignal(child.status() - 128), ")");
    std::string last;
    constexpr std::string_view start = "fenestra: error: ";
    for (const std::string& line : split(child.errors(), '\n'))
      if (line.starts_with(start))
        last = line.substr(start.size());
    return last.empty() ? concat("ended with status ", child.status()) : toOneLine(last);
  }

  /// Stores and prints the outcome of a row.
  void reportOutcome(std::size_t row, const RowOutcome& outcome) {
    m_results.outcomes[row] = outcome;
    ++m_rendered;
    m_seconds += outcome.seconds;
    if (m_view.mode() == ProgressMode::xml)
      return;
    const std::string& name = m_results.rows[row].name;
    if (outcome.state == State::failed)
      printWarning(name + ": " + outcome.error);
    else if (outcome.state == State::done && m_options.verbose)
      printLine(concat(name, ": ", toString(outcome.seconds, 3), " s"));
  }

  /// Sends SIGTERM to all workers once; they write what they have rendered.
  void requestStop() {
    if (std::exchange(m_hasRequestedStop, true))
      return;
    for (const auto& worker : m_workers)
      if (worker)
        worker->child.send(SIGTERM);
  }

  /// Finished fraction of the rows to render, in [0, 1]. Running rows are estimated from the mean
  /// time of finished ones.
  double fraction() const {
    const double toDo = static_cast<double>(m_rows.size() - m_skipped);
    double done = static_cast<double>(m_rendered);
    for (const auto& worker : m_workers)
      if (worker && m_seconds > 0.0)
        done += // a running row counts as at most 0.9
            std::min(0.9, worker->watch.seconds() * static_cast<double>(m_rendered) / m_seconds);
    return toDo > 0.0 ? std::min(1.0, done / toDo) : 1.0;
  }

  std::vector<std::string> statusFields() const {
    std::vector<std::string> fields = {
        concat("row ", std::min(m_skipped + m_rendered + 1, m_rows.size()), " of ", m_rows.size())};
    if (failed() > 0)
      fields.push_back(concat(failed(), " failed"));
    return fields;
  }

  const BatchOptions& m_options;
  BatchResults& m_results;
  ProgressView m_view;
  std::vector<std::size_t> m_rows; ///< of this run
  std::vector<std::unique_ptr<Worker>> m_workers;
  SharedSlot m_smoothedVolume;                           ///< of the last row that smoothed one
  std::size_t m_next = 0, m_skipped = 0, m_rendered = 0; ///< next row; rows done before, done now
  double m_seconds = 0.0;                                ///< sum over the rows done now
  std::atomic<bool> m_stop = false;
  bool m_hasRequestedStop = false;
};

RowShard parseRowShard(const OptionValues& values) {
  const std::string text = values.text("rows").value_or("1/1");
  std::size_t part = 0, parts = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%zu/%zu%c", &part, &parts, &rest) != 2 || part < 1 ||
      parts < part || parts > 100'000)
    throw usageError("--rows: expected K/N with K from 1 to N, got '", toOneLine(text), "'");
  return {part - 1, parts};
}

BatchOptions makeBatchOptions(const OptionValues& values) {
  BatchOptions options;
  options.formats = values.list("formats");
  for (const std::string& format : options.formats)
    if (format != "exr" && format != "nrrd" && format != "tif")
      throw usageError("--formats: expected exr, nrrd or tif, got '", toOneLine(format), "'");
  options.threads = threadCount(values);
  options.workers = static_cast<int>(values.integer("workers").value_or(1));
  options.shard = parseRowShard(values);
  options.restart = values.has("restart");
  const RenderOptions shared = resolveProgress(readOptions(values));
  options.progress = shared.progress;
  options.quiet = shared.quiet;
  options.verbose = shared.verbose;
  return options;
}

/// Values of the render options that apply to all rows.
OptionValues removeBatchOptions(const OptionValues& values) {
  OptionValues common = values;
  for (const Option& option : batchSyntax().options)
    if (!isImageOption(option) && option.name != "layers")
      common.remove(option.name);
  for (const char* name : {"TABLE", "output", "workers", "formats", "rows", "restart"})
    common.remove(name);
  return common;
}

} // namespace

int batchCommand(int argc, char** argv, int first) {
  const std::optional<OptionValues> values = parseCommandLine(batchSyntax(), argc, argv, first);
  if (!values)
    return 0;
  const BatchOptions options = makeBatchOptions(*values);
  BatchResults results{*values->text("TABLE"), {}, {}, {}};
  results.folder = values->text("output").value_or(
      (results.table.parent_path() / results.table.stem()).string());
  results.rows = readBatchTable(results.table, removeBatchOptions(*values));
  results.outcomes.resize(results.rows.size());
  const CreatedFolders made(results.folder);
  Outputs outputs;
  const bool isComplete = options.shard.count == 1; // other shards' rows are not known here
  if (isComplete)
    declareResults(results, outputs);
  const Stopwatch watch;
  Batch batch(options, results);
  batch.run();
  if (isComplete)
    writeResults(results, outputs);
  outputs.commit();
  if (!options.quiet)
    printLine(concat(results.folder, ": ", results.count(State::done), " of ", batch.rows(),
                     " rows done, ", batch.rendered(), " rendered now, ",
                     toString(watch.seconds(), 3), " s",
                     batch.isStopped() ? " (stopped on request; the same command resumes)" : ""));
  if (batch.isStopped())
    return stopStatus();
  for (std::size_t row = 0; row < results.rows.size(); ++row)
    if (const RowOutcome& outcome = results.outcomes[row]; outcome.state == State::failed) {
      constexpr std::array kinds = {ErrorKind::request, ErrorKind::input};
      const auto* const kind = std::ranges::find(kinds, outcome.status, exitStatus);
      throw Error(kind == kinds.end() ? ErrorKind::output : *kind,
                  makeMessage(ErrorCode::failedRows, results.table, batch.failed(), " of ",
                              batch.rows(), " rows failed, the first ", results.rows[row].name,
                              ": ", outcome.error));
    }
  return 0;
}

} // namespace fenestra::core
