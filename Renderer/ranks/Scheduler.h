#pragma once
// Distributes tiles to MPI ranks. Rank 0 owns the film and leases tiles with their pixels' sums;
// the others add samples and return the tiles, complete or not at all. Only rank 0 handles passes,
// sample plans, limits and checkpoints, and a rank that dies costs the film nothing.

#include "integrator/render/Render.h"
#include "ranks/Ranks.h"

#include <thread>

namespace fenestra::core {

/// Rank 0: leases tiles to all other ranks.
class Scheduler {
public:
  explicit Scheduler(Ranks& ranks)
      : m_ranks(ranks), m_workers(static_cast<std::size_t>(ranks.count())) {}
  ~Scheduler();

  /// Starts to lease tiles of the render with this monitor, which must live until the render has
  /// ended.
  void start(RenderMonitor& monitor);
  /// Stops the other ranks. False if one does not respond after a stop was requested: it may have
  /// died.
  bool stopWorkers(bool isStopped);

private:
  struct Worker {
    std::size_t threads = 1;
    bool isIdle = false;  ///< waits for a lease or the end
    bool hasPlan = false; ///< has received RenderResult::last.plan
  };

  void serve(const std::stop_token& end);
  bool receiveResults();
  void dispatchTiles();
  void acceptResult(const RankMessage& message);
  RankMessage makeLease(Worker& worker);
  Counters join(const RenderMonitor& monitor);

  Ranks& m_ranks;
  std::mutex m_mutex;            ///< for all members below
  std::vector<Worker> m_workers; ///< by rank
  RenderMonitor* m_monitor = nullptr;
  Pass* m_pass = nullptr; ///< null: tiles are neither leased nor accepted
  RenderResult* m_result = nullptr;
  Counters m_added;
  std::jthread m_thread; ///< ends before the members above
};

/// Other ranks: renders what rank 0 leases until rank 0 ends it. `monitor.stop`, once true, also
/// stops rank 0.
void runWorker(Ranks& ranks, const SceneView& scene, const RenderSettings& settings,
               RenderMonitor& monitor);

/// Other ranks: waits until rank 0 starts a render; false: there is none.
bool waitForStart(Ranks& ranks);
/// Rank 0: makes all other ranks join a render.
void startWorkers(Ranks& ranks);

} // namespace fenestra::core
