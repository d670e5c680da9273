#pragma once
// Tiles that travel between ranks: rank 0 has the film, and lends tiles with their pixels' sums;
// the others add samples to these, and bring them back. So the film is whole, and rank 0 alone
// knows of passes, plans, limits and checkpoints.

#include "integrator/render/Render.h"
#include "ranks/Ranks.h"

#include <thread>

namespace fenestra {

/// Rank 0: lends tiles to all other ranks.
class Scheduler {
public:
  explicit Scheduler(Ranks& ranks)
      : m_ranks(ranks), m_workers(static_cast<std::size_t>(ranks.count())) {}
  ~Scheduler();

  /// Begins to lend tiles of the render with that monitor, which must live until the render has
  /// ended.
  void start(RenderMonitor& monitor);
  /// Sends the other ranks home. False if they do not answer after a stop was asked for: one may
  /// have died.
  bool stopWorkers(bool isStopped);

private:
  struct Worker {
    std::size_t threads = 1;
    bool isIdle = false;  ///< for tiles, or the end
    bool hasPlan = false; ///< RenderResult::last.plan
  };

  void serve(const std::stop_token& end);
  bool receiveResults();
  void dispatchTiles();
  void acceptResult(const Message& message);
  Message makeLease(Worker& worker);
  Counters join(const RenderMonitor& monitor);

  Ranks& m_ranks;
  std::mutex m_mutex;            ///< of all below
  std::vector<Worker> m_workers; ///< by rank
  RenderMonitor* m_monitor = nullptr;
  Pass* m_pass = nullptr; ///< null: nothing is lent or taken back
  RenderResult* m_result = nullptr;
  Counters m_added;
  std::jthread m_thread; ///< ends before the members above
};

/// Other ranks: renders what rank 0 lends until it says that all is done. `monitor.stop`, once
/// true, stops rank 0, too.
void runWorker(Ranks& ranks, const SceneView& scene, const RenderSettings& settings,
               RenderMonitor& monitor);

/// Other ranks: waits for a render to help with; false: there is none.
bool waitForStart(Ranks& ranks);
/// Rank 0: asks all other ranks to help with a render.
void startWorkers(Ranks& ranks);

} // namespace fenestra
