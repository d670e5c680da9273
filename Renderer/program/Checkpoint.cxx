#include "program/Checkpoint.h"

#include "base/Error.h"
#include "files/medical/ReferencedFiles.h"
#include "io/Digest.h"
#include "io/InputRegistry.h"
#include "io/JsonNode.h"
#include "program/FileNames.h"
#include "program/UsageError.h"
#include "program/about/Version.h"

#include <algorithm>
#include <new>
#include <set>

namespace fenestra::core {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Values of the given options that `isIncluded`, by name; file names relative to `folder`.
template <typename Predicate>
ordered_json collectOptions(const OptionValues& options, const fs::path& folder,
                            Predicate&& isIncluded) {
  ordered_json collected = {{"INPUT", {toRelativeName(*options.text("INPUT"), folder)}}};
  for (const Option& option : renderSyntax.options) {
    if (!options.has(option.name) || !isIncluded(option))
      continue;
    for (const std::string& value : options.texts(option.name))
      collected[option.name].push_back(option.canNameFile() ? toRelativeName(value, folder)
                                                            : value);
  }
  return collected;
}

std::string joinValues(const json& options, const std::string& name) {
  if (!options.contains(name))
    return "not given";
  return join(options.at(name), " ", [](const json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
  });
}

/// First option in which two objects of options differ; empty: none.
std::string findOptionDifference(const json& stored, const json& current) {
  std::set<std::string> names;
  for (const json* options : {&stored, &current})
    for (const auto& [name, values] : options->items())
      names.insert(name);
  for (const std::string& name : names)
    if (stored.value(name, json()) != current.value(name, json()))
      return concat(name == "INPUT" ? "" : "--", name, " was ", joinValues(stored, name), ", is ",
                    joinValues(current, name));
  return "";
}

/// First file in `some` without an equal entry in `others`; empty: none.
std::string findMissingFile(const json& some, const json& others) {
  for (const json& file : some)
    if (std::ranges::find(others, file) == others.end())
      return file.value("file", "");
  return "";
}

/// Automatic smoothing is that of the stored samples, whatever the outputs would choose.
void adoptSmoothing(const CheckpointFile& film, RenderOptions& options) {
  if (options.smoothing.kind != SmoothingRequest::Kind::automatic)
    return;
  const JsonNode settings = JsonNode(film.metadata(), film.path().string()).at("settings");
  const std::vector<JsonNode> values = settings.at(smoothingOption).elements();
  const SmoothingRequest stored =
      values.empty() ? SmoothingRequest() : parseSmoothing(values.front().text());
  RenderRequest& scene = options.scene;
  if (std::exchange(scene.smoothing, stored).kind != stored.kind)
    scene.omissions.push_back(makeMessage(
        ErrorCode::ignoredRequest, concat("--", smoothingOption), film.path(),
        " was rendered from the ", stored.kind == SmoothingRequest::Kind::off ? "raw" : "smoothed",
        " volume, and so is this image; for the other, render it again with another --checkpoint"));
}

} // namespace

bool isSampleOption(const Option& option) {
  constexpr std::string_view ofDisplay[] = {"exposure", "tone", "annotate", "denoise"};
  return isImageOption(option) && option.overrideGroup != OverrideGroup::stop &&
         std::ranges::find(ofDisplay, option.name) == std::end(ofDisplay);
}

ordered_json makeProvenance(const OptionValues& given, const RenderJob& job,
                            const fs::path& folder) {
  ordered_json settings = collectOptions(job.values, folder, isSampleOption);
  settings[smoothingOption] = {formatSmoothing(job.options.scene.smoothing)};
  return {{"version", concat(samplingVersionText, " on ", processorText)},
          {"given", collectOptions(given, folder, isImageOption)},
          {"settings", std::move(settings)}};
}

std::vector<fs::path> listInputFiles(const PreparedScene& scene, const RenderOptions& options) {
  std::set<fs::path> files(options.inputs.begin(), options.inputs.end());
  for (const std::string& file : scene.files())
    files.insert(file);
  for (const fs::path& file : std::set(files))
    for (const fs::path& named : findReferencedFiles(file))
      files.insert(named);
  std::vector<fs::path> existing;
  std::error_code failed;
  std::ranges::copy_if(files, std::back_inserter(existing), [&](const fs::path& file) {
    return fs::is_regular_file(file, failed); // a member of an archive changes with the archive
  });
  return existing;
}

ordered_json digestInputs(const PreparedScene& scene, const RenderOptions& options,
                          const fs::path& folder) {
  ordered_json inputs = ordered_json::array();
  for (const fs::path& file : listInputFiles(scene, options))
    inputs.push_back({{"file", toRelativeName(file.string(), folder)},
                      {"bytes", fs::file_size(file)},
                      {"digest", computeDigest(file)}});
  return inputs;
}

std::string findDifference(const json& stored, const json& current, const std::string& source) {
  const JsonNode node(stored, source);
  for (const auto& [key, value] : current.items()) {
    const json& before = node.at(key).value();
    if (before == value)
      continue;
    if (key == "settings") {
      if (!before.is_object())
        throw node.at(key).error("must be an object");
      return findOptionDifference(before, value);
    }
    if (key == "inputs") {
      for (const JsonNode& file : node.at(key).elements())
        file.at("file").text();
      const std::string now = findMissingFile(value, before);
      return (now.empty() ? findMissingFile(before, value) : now) + " has changed";
    }
    return concat(key, " was ", node.at(key).text(), ", is ", value.get<std::string>());
  }
  return "";
}

Error Checkpoint::mismatchError(const std::string& difference) const {
  return usageError(m_path, ": belongs to another render: ", difference,
                    m_isMerge ? "; restore inputs and checkpoint files, or render again"
                              : "; use another --checkpoint, or move this file away to start "
                                "over");
}

std::string formatShard(const Shard& shard) {
  return concat(shard.index + 1, '/', shard.count);
}

Checkpoint::Checkpoint(RenderJob& job, const OptionValues& given, Warn warn)
    : m_job(job),
      m_path(*job.options.checkpoint),
      m_warn(std::move(warn)),
      m_lock(m_path),
      m_provenance(makeProvenance(given, job, m_path.parent_path())) {
  if (!m_lock->isHeld())
    throw usageError(m_path, ": another process is writing this file; wait for it, or use another "
                             "--checkpoint");
  std::error_code failed;
  if (fileExists(m_path) &&
      !(fs::is_regular_file(m_path, failed) && fs::is_empty(m_path, failed))) {
    const CheckpointFile& film = m_files.emplace_back(m_path);
    requireSettings(film, job);
    if (const Shard& here = job.options.settings.shard; film.shard() != here)
      throw mismatchError(
          concat("--shard was ", formatShard(film.shard()), ", is ", formatShard(here)));
    unregisterInput(*fileId(m_path)); // since it is also an output
  }
  m_outputs.add(m_path);
}

Checkpoint::Checkpoint(RenderJob& job, const OptionValues& given,
                       std::vector<CheckpointFile> shards)
    : m_job(job),
      m_path(shards.front().path()),
      m_files(std::move(shards)),
      m_isMerge(true),
      m_provenance(makeProvenance(given, job, m_path.parent_path())) {
  requireSettings(m_files.front(), job);
}

void Checkpoint::requireSettings(const CheckpointFile& film, RenderJob& job) {
  requireSame(film, "version");
  adoptSmoothing(film, job.options);
  m_provenance["settings"][smoothingOption] = {formatSmoothing(job.options.scene.smoothing)};
  requireSame(film, "settings");
}

void Checkpoint::requireSame(const CheckpointFile& film, const std::string& key) const {
  const auto difference =
      findDifference(film.metadata(), {{key, m_provenance.at(key)}}, m_path.string());
  if (!difference.empty())
    throw mismatchError(difference);
}

/// Existing samples cannot be removed or redistributed between pixels.
void Checkpoint::checkSampleCounts(const RenderResult& result,
                                   const RenderSettings& settings) const {
  if (settings.samples < result.begunSamples)
    throw usageError("--samples: ", m_path, " has up to ", result.begunSamples,
                     " samples per pixel; ask for at least as many, or use another --checkpoint");
  const bool wasPlanned = result.last.noise < infinity;
  if (result.begunSamples > SamplePlan::pilotSamples && wasPlanned != settings.isAdaptive())
    throw usageError("--noise: ", m_path, wasPlanned ? " was" : " was not",
                     " rendered with a raw --noise, which gives noisier pixels more samples; ",
                     wasPlanned ? "add one" : "omit it", ", or use another --checkpoint");
}

std::optional<RenderResult> Checkpoint::load(const PreparedScene& scene,
                                             const RenderSettings& settings) {
  m_provenance["inputs"] = digestInputs(scene, m_job.options, m_path.parent_path());
  if (m_files.empty())
    return std::nullopt;
  const CheckpointFile& first = m_files.front();
  requireSame(first, "inputs");
  if (const std::string here = findTarget(scene.view(), settings); first.target() != here)
    throw mismatchError(concat("its instruction set was ", first.target(), ", is ", here,
                               " (set FENESTRA_INSTRUCTIONS to change it)"));
  const RenderRequest& request = m_job.options.scene;
  if (first.width() != request.width || first.height() != request.height)
    throw inputError(m_path, "size differs from the stored settings; render it again");
  RenderResult result = first.readProgress();
  if (!m_isMerge)
    checkSampleCounts(result, settings);
  result.counters = {};
  for (const CheckpointFile& film : m_files) {
    film.readPixels(result.film);
    result.counters += film.counters();
  }
  m_files.clear();
  m_savedPaths = result.counters.paths;
  return result;
}

void Checkpoint::attach(RenderMonitor& monitor) {
  if (m_isMerge)
    return;
  using Clock = RenderMonitor::Clock;
  monitor.pauseAt = Clock::now() + std::chrono::seconds(1);
  monitor.onPause = [this, &monitor](const RenderResult& result) {
    const Clock::time_point start = Clock::now();
    if (start < monitor.pauseAt.load())
      return;
    trySave(result);
    const Clock::time_point end = Clock::now();
    monitor.pauseAt = end + std::min<Clock::duration>(100 * (end - start), std::chrono::minutes(1));
  };
}

void Checkpoint::trySave(const RenderResult& result) {
  std::string failure;
  try {
    save(result);
  } catch (const Error& error) {
    failure = error.what();
  } catch (const std::bad_alloc&) {
    failure = m_path.string() + ": not enough memory to write it";
  }
  if (!failure.empty() && !std::exchange(m_hasWarned, true))
    m_warn(failure + " (the render continues without this checkpoint)");
}

void Checkpoint::save(const RenderResult& result) {
  if (result.counters.paths == m_savedPaths)
    return;
  m_outputs.write(m_path, encodeCheckpoint(result, m_job.options.settings.shard, m_provenance));
  m_outputs.commit();
  m_savedPaths = result.counters.paths;
}

} // namespace fenestra::core
