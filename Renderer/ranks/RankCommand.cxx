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
#include "ranks/SharedRender.h"

#include <algorithm>
#include <new>

namespace fenestra::core {
namespace {

namespace fs = std::filesystem;

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

/// Waits until rank 0 wants to render, or ends without. Returns whether it does.
bool startTogether(const Ranks& ranks, bool isWanted) {
  std::uint64_t isStarted[] = {isWanted};
  ranks.minimize(isStarted);
  return isStarted[0] != 0;
}

/// Ends all ranks with the message of the current exception.
[[noreturn]] void abortRanks(const Ranks& ranks) {
  try {
    throw;
  } catch (const Error& error) {
    ranks.abort(composeMessage(error.message()), exitStatus(error.kind()));
  } catch (const std::bad_alloc&) {
    ranks.abort("out of memory; use fewer ranks per machine, or a smaller image",
                exitStatus(ErrorKind::output));
  } catch (const std::exception& error) {
    ranks.abort(error.what(), exitStatus(ErrorKind::output));
  }
}

/// Rank 0: sends everything from which the other ranks prepare the same render.
void sendRender(const RenderOptions& options, const PreparedScene& scene,
                const RenderSettings& settings, const Ranks& ranks) {
  std::vector<fs::path> files = listInputFiles(scene, options);
  std::error_code failed;
  if (options.checkpoint && fs::is_regular_file(*options.checkpoint, failed) &&
      !fs::is_empty(*options.checkpoint))
    files.push_back(*options.checkpoint);
  broadcastFiles(files, ranks);
  std::string smoothing = formatSmoothing(options.scene.smoothing),
              text = describeScene(scene, settings);
  ranks.broadcast(smoothing);
  ranks.broadcast(text);
}

/// Rank 0: the complete command.
int runFirstRank(int argc, char** argv, const Ranks& ranks,
                 const std::vector<std::string>& targets) {
  bool isStarted = false;
  try {
    requireSameRanks(targets);
    const auto share = [&](const RenderOptions& options, const PreparedScene& scene,
                           RenderSettings& settings, RenderMonitor& monitor) {
      isStarted = startTogether(ranks, true);
      sendRender(options, scene, settings, ranks);
      shareRender(ranks, Tiles(options.scene.width, options.scene.height), settings, monitor);
    };
    const int status = runRender(share, argc, argv, findFirstArgument(argc, argv));
    if (!isStarted)
      startTogether(ranks, false);
    return status;
  } catch (...) {
    if (isStarted) // the other ranks may wait for this one
      abortRanks(ranks);
    startTogether(ranks, false);
    throw;
  }
}

/// Other ranks: their part of the image that rank 0 renders from the same arguments.
void runOtherRank(int argc, char** argv, const Ranks& ranks) {
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
  std::optional<RenderResult> begun;
  if (const auto& name = job.options.checkpoint; name && fs::exists(files->localPath(*name))) {
    const CheckpointFile checkpoint(files->localPath(*name));
    begun = checkpoint.readProgress();
    checkpoint.readPixels(begun->film);
    begun->counters = {}; // rank 0 counts them
  }
  files.reset();
  RenderSettings settings = makeSettings(job.options, scene.background());
  if (const std::string own = describeScene(scene, settings); own != expected)
    throw inputError(request.input, "scene differs from rank 0's (", own, ", not ", expected,
                     "); a file that it refers to may differ between machines");
  RenderMonitor monitor;
  const DeferredStop deferredStop(monitor.stop);
  shareRender(ranks, Tiles(request.width, request.height), settings, monitor);
  render(scene.view(), settings, monitor, std::move(begun));
}

} // namespace

int dispatchRank(int argc, char** argv) {
  pinInstructions();
  const Ranks ranks;
  if (ranks.count() == 1)
    return dispatch(argc, argv);
  const std::jthread relay = relayStops();
  const std::vector<std::string> targets =
      ranks.allGather(concat(versionText, " on ", processorText, " by ", instructionSet()));
  if (ranks.rank() == 0)
    return runFirstRank(argc, argv, ranks, targets);
  try {
    if (startTogether(ranks, true))
      runOtherRank(argc, argv, ranks);
  } catch (...) {
    abortRanks(ranks);
  }
  return 0;
}

} // namespace fenestra::core
