#include "ranks/Scheduler.h"

#include "base/Error.h"
#include "base/Stopwatch.h"
#include "image/PixelWords.h"
#include "integrator/render/TileStream.h"
#include "program/ErrorAdvice.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <condition_variable>
#include <new>
#include <utility>

namespace fenestra::core {
namespace {

/// First word of each message from rank 0.
constexpr std::uint64_t startTag = 1, leaseTag = 2, stopTag = 3;

constexpr std::size_t maxLeaseTiles = 4096; ///< 60 MB

/// Reads the words of a message in order.
class MessageReader {
public:
  explicit MessageReader(const RankMessage& message) : m_message(message) {}

  std::uint64_t word() { return m_message.at(m_next++); }
  std::size_t wordsLeft() const { return m_message.size() - m_next; }

private:
  const RankMessage& m_message;
  std::size_t m_next = 0;
};

/// Calls each(pixel) for the pixels of tiles, in their order.
template <typename Each>
void forEachTilePixel(std::span<const int> tiles, Film& film, Each&& each) {
  const Tiles layout(film.width(), film.height());
  for (const int number : tiles) {
    const Tiles::Tile tile = layout.at(number);
    for (int row = tile.top; row < tile.bottom; ++row)
      for (int column = tile.left; column < tile.right; ++column)
        each(film.at(column, row));
  }
}

/// Appends the number of tiles, the tiles, and the sums of their pixels.
void writeTiles(std::span<const int> tiles, Film& film, RankMessage& message) {
  message.push_back(tiles.size());
  message.insert(message.end(), tiles.begin(), tiles.end());
  message.reserve(message.size() + tiles.size() * Tiles::size * Tiles::size * wordsPerPixel);
  forEachTilePixel(tiles, film, [&](const PixelSums& pixel) {
    const PixelWords words = toWords(pixel);
    message.insert(message.end(), words.begin(), words.end());
  });
}

/// Copies the sums of pixels to the film; returns their tiles.
std::vector<int> readTiles(MessageReader& reader, Film& film) {
  std::vector<int> tiles(reader.word());
  for (int& tile : tiles)
    tile = static_cast<int>(reader.word());
  forEachTilePixel(tiles, film, [&](PixelSums& pixel) {
    PixelWords words = {};
    for (std::uint64_t& word : words)
      word = reader.word();
    fromWords(words, pixel);
  });
  return tiles;
}

/// Calls each(counter) in the order of messages.
template <typename Each>
void forEachCounter(Counters& counters, Each&& each) {
  for (std::uint64_t* count :
       {&counters.paths, &counters.collisions, &counters.lookups, &counters.cells,
        &counters.skippedCells, &counters.shadowRays, &counters.gradients})
    each(*count);
}

/// Leases of a rank other than 0.
class LeasedTiles {
public:
  LeasedTiles(Ranks& ranks, RenderMonitor& monitor) : m_ranks(ranks), m_monitor(monitor) {}

  /// Returns the previous lease's tiles and waits for the next; nullopt: there are no more.
  std::optional<TileLease> next(RenderResult& result) {
    m_watch = {};
    returnTiles(result);
    for (const BackoffPoller poller;;) {
      const std::optional<ReceivedMessage> received = m_ranks.receive();
      if (!received) {
        poller.wait();
        continue;
      }
      MessageReader reader(received->message);
      if (reader.word() == stopTag)
        return std::nullopt;
      TileLease lease = {{}, reader.word(), reader.word()}; // samples, from and to
      m_tiles = lease.tiles = readTiles(reader, result.film);
      if (reader.wordsLeft() > 0)
        readPlan(reader, result);
      watch();
      return lease;
    }
  }

private:
  void returnTiles(RenderResult& result) {
    const bool isStopped = m_monitor.stop;
    RankMessage message = {isStopped,
                           static_cast<std::uint64_t>(tbb::this_task_arena::max_concurrency())};
    forEachCounter(result.counters, [&](std::uint64_t count) { message.push_back(count); });
    writeTiles(isStopped ? std::span<const int>() : std::span<const int>(m_tiles), result.film,
               message);
    m_tiles.clear();
    m_ranks.send(0, message);
  }

  static void readPlan(MessageReader& reader, RenderResult& result) {
    std::vector<float> plan(reader.wordsLeft());
    for (float& noise : plan) // per pixel
      noise = std::bit_cast<float>(static_cast<std::uint32_t>(reader.word()));
    result.last.plan = SamplePlan(std::move(plan));
  }

  /// Stops the current lease if a message arrives meanwhile: only stopTag can arrive then.
  void watch() {
    m_watch = std::jthread([this](const std::stop_token& end) {
      std::mutex mutex;
      std::condition_variable_any wake;
      std::unique_lock lock(mutex);
      while (!end.stop_requested() && !m_monitor.stop) {
        if (m_ranks.hasMessage())
          m_monitor.stop = true;
        wake.wait_for(lock, end, std::chrono::milliseconds(20), [] { return false; });
      }
    });
  }

  Ranks& m_ranks;
  RenderMonitor& m_monitor;
  std::vector<int> m_tiles; ///< of the current lease
  std::jthread m_watch;
};

} // namespace

// ---- rank 0

void startWorkers(Ranks& ranks) {
  for (int rank = 1; rank < ranks.count(); ++rank)
    ranks.send(rank, {startTag});
}

Scheduler::~Scheduler() {
  m_thread = {};
}

void Scheduler::start(RenderMonitor& monitor) {
  m_monitor = &monitor;
  monitor.workers = {m_ranks.count() - 1,
                     [this](Pass& pass, RenderResult& result) {
                       const std::lock_guard lock(m_mutex);
                       m_pass = &pass;
                       m_result = &result;
                     },
                     [this](const RenderMonitor& current) { return join(current); }};
  m_thread = std::jthread([this](const std::stop_token& end) { serve(end); });
}

void Scheduler::serve(const std::stop_token& end) {
  BackoffPoller poller;
  try {
    while (!end.stop_requested()) {
      {
        const std::lock_guard lock(m_mutex);
        if (m_pass) {
          if (receiveResults())
            poller.reset();
          dispatchTiles();
        }
      }
      poller.wait();
    }
  } catch (const std::bad_alloc&) {
    m_ranks.abort("out of memory; use a smaller image", exitStatus(ErrorKind::output));
  }
}

/// Handles all pending messages; false if there are none. The caller holds m_mutex.
bool Scheduler::receiveResults() {
  bool hasReceived = false;
  while (const std::optional<ReceivedMessage> received = m_ranks.receive()) {
    hasReceived = true;
    Worker& worker = m_workers[static_cast<std::size_t>(received->from)];
    worker.isIdle = true;
    acceptResult(received->message);
    worker.threads = received->message[1]; // as in LeasedTiles::returnTiles
  }
  return hasReceived;
}

/// Adds a worker's samples to the film. The caller holds m_mutex.
void Scheduler::acceptResult(const RankMessage& message) {
  MessageReader reader(message);
  if (reader.word() != 0)
    m_monitor->stop = true;
  reader.word(); // the number of threads
  Counters counters;
  forEachCounter(counters, [&](std::uint64_t& count) { count = reader.word(); });
  m_added += counters;
  for (const int tile : readTiles(reader, m_result->film))
    m_pass->returnTile(tile);
}

/// Leases tiles to all idle workers. The caller holds m_mutex.
void Scheduler::dispatchTiles() {
  for (std::size_t rank = 1; rank < m_workers.size(); ++rank) {
    Worker& worker = m_workers[rank];
    if (m_monitor->stop || m_pass->tilesLeft() == 0)
      return;
    if (!worker.isIdle)
      continue;
    worker.isIdle = false;
    m_ranks.send(static_cast<int>(rank), makeLease(worker));
  }
}

/// Leases a fraction of the pass's remaining tiles. Leases shrink toward the end of the pass, so
/// that all ranks finish it together. The caller holds m_mutex.
RankMessage Scheduler::makeLease(Worker& worker) {
  const std::size_t fair = m_pass->tilesLeft() / (2 * m_workers.size());
  const std::size_t wanted = std::min(std::max(fair, 2 * worker.threads), maxLeaseTiles);
  RankMessage message = {leaseTag, m_result->finishedSamples, m_result->begunSamples};
  writeTiles(m_pass->take(wanted), m_result->film, message);
  const std::vector<float>& plan = m_result->last.plan.noise();
  if (!plan.empty() && !std::exchange(worker.hasPlan, true))
    for (const float noise : plan)
      message.push_back(std::bit_cast<std::uint32_t>(noise));
  return message;
}

Counters Scheduler::join(const RenderMonitor& monitor) {
  for (const BackoffPoller poller;;) {
    {
      const std::lock_guard lock(m_mutex);
      if (m_pass->isComplete() || monitor.stop ||
          (monitor.isCheckpointDue && monitor.isCheckpointDue())) {
        m_pass = nullptr;
        return std::exchange(m_added, {});
      }
    }
    poller.wait();
  }
}

bool Scheduler::stopWorkers(bool isStopped) {
  constexpr double maxSeconds = 2.0;
  m_thread = {};
  const bool isBegun = m_monitor != nullptr;
  for (int rank = 1; rank < m_ranks.count(); ++rank)
    m_ranks.send(rank, {stopTag});
  std::size_t busyCount = 0;
  for (std::size_t rank = 1; isBegun && rank < m_workers.size(); ++rank)
    busyCount += m_workers[rank].isIdle ? 0 : 1;
  const Stopwatch watch;
  const BackoffPoller poller;
  while (busyCount > 0 && (!isStopped || watch.seconds() < maxSeconds)) {
    if (m_ranks.receive())
      --busyCount;
    else
      poller.wait();
  }
  return busyCount == 0;
}

// ---- other ranks

bool waitForStart(Ranks& ranks) {
  for (const BackoffPoller poller;;) {
    if (const std::optional<ReceivedMessage> received = ranks.receive())
      return received->message.front() == startTag;
    poller.wait();
  }
}

void runWorker(Ranks& ranks, const SceneView& scene, const RenderSettings& settings,
               RenderMonitor& monitor) {
  LeasedTiles tiles(ranks, monitor);
  renderLeases(scene, settings, monitor,
               [&tiles](RenderResult& result) { return tiles.next(result); });
}

} // namespace fenestra::core
