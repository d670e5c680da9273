// Imbalance of the shards that the ranks of fenestra-mpi render: CPU seconds of the largest over
// the mean, for 2 to 64 ranks.
//
//     ShardBenchmark ARGUMENTS...     (of `fenestra`); prints CSV

#include "io/platform/ProcessState.h"
#include "program/CommandLine.h"
#include "program/ErrorAdvice.h"
#include "program/RenderSteps.h"

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <numeric>

namespace fenestra::core {
namespace {

constexpr int maxRanks = 64;

/// Work of each shard.
struct Work {
  std::vector<double> cpuSeconds; ///< of one thread
  std::vector<double> lookups; ///< Counters::lookups, nearly proportional and without timing noise
};

Work measureShards(const PreparedScene& scene, RenderSettings settings) {
  settings.threads = 1;
  settings.noise = -1.0;
  Work work;
  for (int index = 0; index < maxRanks; ++index) {
    settings.shard = {index, maxRanks};
    RenderMonitor monitor;
    const double before = readResourceUsage().cpuSeconds;
    const RenderResult result = render(scene.view(), settings, monitor);
    work.cpuSeconds.push_back(readResourceUsage().cpuSeconds - before);
    work.lookups.push_back(static_cast<double>(result.counters.lookups));
  }
  return work;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double largestToMean(const std::vector<double>& values) {
  return *std::ranges::max_element(values) / mean(values);
}

/// Work of half as many shards. Tiles are dealt out in turn, so shard k of n / 2 consists of the
/// shards k and k + n / 2 of n.
void joinHalves(std::vector<double>& values) {
  const std::size_t half = values.size() / 2;
  for (std::size_t k = 0; k < half; ++k)
    values[k] += values[k + half];
  values.resize(half);
}

void measure(const RenderJob& job) {
  const PreparedScene scene(job.options.scene, job.input);
  auto [seconds, lookups] = measureShards(scene, makeSettings(job.options, scene.background()));
  std::cout << "ranks,cpu_seconds,cpu_seconds_largest_to_mean,lookups_largest_to_mean\n"
            << std::fixed << std::setprecision(3);
  while (seconds.size() > 1) {
    std::cout << seconds.size() << ',' << mean(seconds) << ',' << largestToMean(seconds) << ','
              << largestToMean(lookups) << std::endl;
    joinHalves(seconds);
    joinHalves(lookups);
  }
}

} // namespace
} // namespace fenestra::core

int main(int argc, char** argv) {
  using namespace fenestra::core;
  try {
    if (const auto values = parseCommandLine(renderSyntax, argc, argv, 1))
      measure(makeRenderJob(*values));
    return 0;
  } catch (const Error& error) {
    std::cerr << "ShardBenchmark: " << error.what() << '\n';
    return exitStatus(error.kind());
  }
}
