#include "ranks/RankCommand.h"

#include "base/Error.h"
#include "base/InstructionSets.h"
#include "program/CommandLine.h"
#include "program/Commands.h"
#include "program/ErrorAdvice.h"
#include "program/RenderCommand.h"
#include "program/Stop.h"
#include "program/UsageError.h"
#include "program/about/Version.h"
#include "ranks/FileBroadcast.h"
#include "ranks/Scheduler.h"

#include <algorithm>
#include <new>

namespace fenestra::core {
namespace {

/// Index of the first argument of a render. Throws Error (usage) for another command.
int findFirstArgument(int argc, char** argv) {
  const std::string word = argc > 1 ? argv[1] : "";
  if (word == renderSyntax.name)
    return 2;
  for (const Command& command : commands())
    if (word == command.syntax().name)
      throw usageError(word, ": mpirun supports render only; run this command without mpirun, in "
                             "one process or as an array job");
  return 1;
}

/// Throws Error (usage) unless all ranks compute the same samples.
void requireSameRanks(const std::vector<std::string>& targets) {
  const auto other = std::ranges::find_if(
      targets, [&](const std::string& text) { return text != targets.front(); });
  if (other != targets.end())
    throw usageError("mpirun: rank ", other - targets.begin(), " is ", *other, ", rank 0 is ",
                     targets.front(),
                     "; use one build, and set FENESTRA_INSTRUCTIONS to a set that all support");
}

/// Properties that differ if the scenes do: the range of the voxels, the camera, the majorants.
std::string describeScene(const PreparedScene& scene, const RenderSettings& settings) {
  constexpr int exact = 17; // significant digits
  const CameraPose& pose = scene.camera().pose();
  const MajorantGrid& majorants = scene.view().majorants;
  return concat(
      findTarget(scene.view(), settings), "; voxels ", toString(scene.volume().minimum, exact),
      " to ", toString(scene.volume().maximum, exact), "; camera at ",
      joinNumbers(pose.position, ",", exact), " toward ", joinNumbers(pose.target, ",", exact),
      "; ", majorants.size(), " cells, ", majorants.emptyCount(), " of them empty");
}

/// Makes the other ranks prepare the scene and render tiles of it.
void startRanks(const RenderOptions& options, const PreparedScene& scene,
                const RenderSettings& settings, RenderMonitor& monitor, Ranks& ranks,
                Scheduler& scheduler) {
  startWorkers(ranks);
  try {
    broadcastFiles(listInputFiles(scene, options), ranks);
    std::string smoothing = formatSmoothing(options.scene.smoothing),
                text = describeScene(scene, settings);
    ranks.broadcast(smoothing);
    ranks.broadcast(text);
  } catch (const Error& error) { // without an abort, the other ranks would wait for more bytes
    ranks.abort(composeMessage(error.message()), exitStatus(error.kind()));
  } catch (const std::exception& error) {
    ranks.abort(error.what(), exitStatus(ErrorKind::input));
  }
  scheduler.start(monitor);
}

/// Rank 0: the complete command.
int runFirstRank(int argc, char** argv, Ranks& ranks, const std::vector<std::string>& targets) {
  Scheduler scheduler(ranks);
  try {
    requireSameRanks(targets);
    const auto start = [&](const RenderOptions& options, const PreparedScene& scene,
                           const RenderSettings& settings, RenderMonitor& monitor) {
      startRanks(options, scene, settings, monitor, ranks, scheduler);
    };
    const int status = runRender(start, argc, argv, findFirstArgument(argc, argv));
    if (!scheduler.stopWorkers(status == stoppedStatus))
      ranks.abort("stopped; other ranks do not respond", status);
    return status;
  } catch (...) {
    scheduler.stopWorkers(true);
    throw;
  }
}

/// Other ranks: tiles of the image that rank 0 renders from the same arguments.
void runOtherRank(int argc, char** argv, Ranks& ranks) {
  const std::optional<OptionValues> given =
      parseCommandLine(renderSyntax, argc, argv, findFirstArgument(argc, argv));
  configureMachine(*given);
  std::optional<ReceivedFiles> files(ranks);
  std::string smoothing, expected;
  ranks.broadcast(smoothing);
  ranks.broadcast(expected);
  RenderJob job = makeRenderJob(files->localizePaths(*given, renderSyntax.options));
  RenderRequest& request = job.options.scene;
  request.features = request.measure = false;    // rank 0 alone needs them
  request.smoothing = parseSmoothing(smoothing); // may be that of rank 0's checkpoint
  checkMemory(request);
  const PreparedScene scene(request, job.input);
  files.reset();
  const RenderSettings settings = makeSettings(job.options, scene.background());
  if (const std::string own = describeScene(scene, settings); own != expected)
    throw inputError(request.input, "scene differs from rank 0's (", own, ", not ", expected,
                     "); a file that it refers to may differ between machines");
  RenderMonitor monitor;
  const DeferredStop deferredStop(monitor.stop);
  runWorker(ranks, scene.view(), settings, monitor);
}

} // namespace

int dispatchRank(int argc, char** argv) {
  pinInstructions();
  Ranks ranks;
  if (ranks.count() == 1)
    return dispatch(argc, argv);
  const std::vector<std::string> targets =
      ranks.allGather(concat(versionText, " on ", processorText, " by ", instructionSet()));
  if (ranks.rank() == 0)
    return runFirstRank(argc, argv, ranks, targets);
  if (!waitForStart(ranks))
    return 0;
  try {
    runOtherRank(argc, argv, ranks);
  } catch (const Error& error) {
    ranks.abort(composeMessage(error.message()), exitStatus(error.kind()));
  } catch (const std::bad_alloc&) {
    ranks.abort("out of memory; use fewer ranks per machine, or a smaller image",
                exitStatus(ErrorKind::output));
  } catch (const std::exception& error) {
    ranks.abort(error.what(), exitStatus(ErrorKind::output));
  }
  return 0;
}

} // namespace fenestra::core
