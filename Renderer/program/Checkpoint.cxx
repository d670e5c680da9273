#include "program/Checkpoint.h"

#include "base/Error.h"
#include "base/safe/Digest.h"
#include "base/safe/Inputs.h"
#include "base/safe/JsonNode.h"
#include "files/medical/NamedFiles.h"
#include "program/FileNames.h"
#include "program/about/Version.h"

#include <algorithm>
#include <new>
#include <set>

namespace fenestra {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Values of the given flags that `isTold`, by name; names of files relative to `folder`.
template <typename IsTold>
ordered_json toldFlags(const OptionValues& flags, const fs::path& folder, IsTold&& isTold) {
  ordered_json told = {{"INPUT", {relativeName(*flags.text("INPUT"), folder)}}};
  for (const Option& flag : renderSyntax.options) {
    if (!flags.has(flag.name) || !isTold(flag))
      continue;
    for (const std::string& value : flags.texts(flag.name))
      told[flag.name].push_back(flag.canNameFile() ? relativeName(value, folder) : value);
  }
  return told;
}

std::string toldValues(const json& flags, const std::string& name) {
  if (!flags.contains(name))
    return "not given";
  return join(flags.at(name), " ", [](const json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
  });
}

/// First flag in which two objects of flags differ; empty: none.
std::string flagDifference(const json& there, const json& here) {
  std::set<std::string> names;
  for (const json* flags : {&there, &here})
    for (const auto& [name, values] : flags->items())
      names.insert(name);
  for (const std::string& name : names)
    if (there.value(name, json()) != here.value(name, json()))
      return concat(name == "INPUT" ? "" : "--", name, " was ", toldValues(there, name), ", is ",
                    toldValues(here, name));
  return "";
}

/// First file of `some` that `others` lack, with its content; empty: none.
std::string missingFile(const json& some, const json& others) {
  for (const json& file : some)
    if (std::ranges::find(others, file) == others.end())
      return file.value("file", "");
  return "";
}

} // namespace

bool shapesSamples(const Option& flag) {
  const bool isShown = flag.name == "exposure" || flag.name == "tone" || flag.name == "denoise";
  return isImageOption(flag) && flag.overrideGroup != OverrideGroup::stop && !isShown;
}

ordered_json madeWith(const OptionValues& given, const OptionValues& flags,
                      const fs::path& folder) {
  return {{"version", concat(versionText, " on ", processorText)},
          {"given", toldFlags(given, folder, isImageOption)},
          {"settings", toldFlags(flags, folder, shapesSamples)}};
}

std::vector<fs::path> filesOf(const PreparedScene& scene, const RenderOptions& options) {
  std::set<fs::path> files(options.inputs.begin(), options.inputs.end());
  for (const std::string& file : scene.files())
    files.insert(file);
  for (const fs::path& file : std::set(files))
    for (const fs::path& part : filesNamedBy(file))
      files.insert(part);
  std::vector<fs::path> there;
  std::error_code failed;
  std::ranges::copy_if(files, std::back_inserter(there), [&](const fs::path& file) {
    return fs::is_regular_file(file, failed); // a member of an archive changes with the archive
  });
  return there;
}

ordered_json inputsOf(const PreparedScene& scene, const RenderOptions& options,
                      const fs::path& folder) {
  ordered_json inputs = ordered_json::array();
  for (const fs::path& file : filesOf(scene, options))
    inputs.push_back({{"file", relativeName(file.string(), folder)},
                      {"bytes", fs::file_size(file)},
                      {"digest", digestOf(file)}});
  return inputs;
}

std::string firstDifference(const json& there, const json& here, const std::string& source) {
  const JsonNode node(there, source);
  for (const auto& [key, value] : here.items()) {
    const json& before = node.at(key).value();
    if (before == value)
      continue;
    if (key == "settings") {
      if (!before.is_object())
        throw node.at(key).error("must be an object");
      return flagDifference(before, value);
    }
    if (key == "inputs") {
      for (const JsonNode& file : node.at(key).elements())
        file.at("file").text();
      const std::string now = missingFile(value, before);
      return (now.empty() ? missingFile(before, value) : now) + " has changed since";
    }
    return concat(key, " was ", node.at(key).text(), ", is ", value.get<std::string>());
  }
  return "";
}

Error Checkpoint::otherRender(const std::string& difference) const {
  return usageError(m_path, ": is of another render: ", difference,
                    m_isMerge ? "; put inputs and films back as they were, or render anew"
                              : "; choose another --checkpoint, or move this one away to begin "
                                "anew");
}

std::string partText(const Shard& shard) {
  return concat(shard.index + 1, '/', shard.count);
}

Checkpoint::Checkpoint(const PictureRequest& job, const OptionValues& given, Warn warn)
    : m_job(job),
      m_path(*job.options.checkpoint),
      m_warn(std::move(warn)),
      m_lock(m_path),
      m_made(madeWith(given, job.flags, m_path.parent_path())) {
  if (!m_lock->isHeld())
    throw usageError(m_path, ": another process is writing this film; wait for it, or choose "
                             "another --checkpoint");
  std::error_code failed;
  if (isThere(m_path) && !(fs::is_regular_file(m_path, failed) && fs::is_empty(m_path, failed))) {
    const FilmFile& film = m_films.emplace_back(m_path);
    for (const char* key : {"version", "settings"})
      requireSame(film, key);
    if (const Shard& here = job.options.settings.shard; film.shard() != here)
      throw otherRender(concat("--shard was ", partText(film.shard()), ", is ", partText(here)));
    forgetInput(*fileId(m_path)); // it is written again
  }
  m_outputs.add(m_path);
}

Checkpoint::Checkpoint(const PictureRequest& job, const OptionValues& given,
                       std::vector<FilmFile> parts)
    : m_job(job),
      m_path(parts.front().path()),
      m_films(std::move(parts)),
      m_isMerge(true),
      m_made(madeWith(given, job.flags, m_path.parent_path())) {
  for (const char* key : {"version", "settings"})
    requireSame(m_films.front(), key);
}

void Checkpoint::requireSame(const FilmFile& film, const std::string& key) const {
  const auto difference = firstDifference(film.made(), {{key, m_made.at(key)}}, m_path.string());
  if (!difference.empty())
    throw otherRender(difference);
}

/// Samples are never taken back, nor dealt out anew.
void Checkpoint::requireRoom(const RenderResult& result, const RenderSettings& settings) const {
  if (settings.samples < result.begunSamples)
    throw usageError("--samples: ", m_path, " has up to ", result.begunSamples,
                     " samples a pixel; ask for as many, or choose another --checkpoint");
  const bool wasPlanned = result.last.noise < infinity;
  if (result.begunSamples > SamplePlan::pilotSamples && wasPlanned != settings.plansByNoise())
    throw usageError("--noise: ", m_path, wasPlanned ? " has" : " lacks",
                     " more samples where the picture is noisier, as only a raw --noise asks for; ",
                     wasPlanned ? "give one" : "drop it", ", or choose another --checkpoint");
}

std::optional<RenderResult> Checkpoint::begun(const PreparedScene& scene,
                                              const RenderSettings& settings) {
  m_made["inputs"] = inputsOf(scene, m_job.options, m_path.parent_path());
  if (m_films.empty())
    return std::nullopt;
  const FilmFile& first = m_films.front();
  requireSame(first, "inputs");
  if (const std::string here = targetOf(scene.view(), settings); first.target() != here)
    throw otherRender(concat("its instruction set was ", first.target(), ", is ", here,
                             " (the environment variable FENESTRA_INSTRUCTIONS chooses)"));
  const RenderRequest& request = m_job.options.scene;
  if (first.width() != request.width || first.height() != request.height)
    throw inputError(m_path, "has another size than its settings say; render it again");
  RenderResult result = first.begun();
  if (!m_isMerge)
    requireRoom(result, settings);
  result.counters = {};
  for (const FilmFile& film : m_films) {
    film.read(result.film);
    result.counters += film.counters();
  }
  m_films.clear();
  m_paths = result.counters.paths;
  return result;
}

void Checkpoint::watch(RenderMonitor& monitor) {
  if (m_isMerge)
    return;
  m_watch = Stopwatch();
  monitor.isCheckpointDue = [this] { return m_watch.seconds() >= m_due; };
  monitor.onCheckpoint = [this](const RenderResult& result) { keep(result); };
}

void Checkpoint::keep(const RenderResult& result) {
  constexpr double share = 0.01, longest = 60.0; // of the time; s
  const Stopwatch cost;
  std::string failure;
  try {
    write(result);
  } catch (const Error& error) {
    failure = error.what();
  } catch (const std::bad_alloc&) {
    failure = m_path.string() + ": there is no memory to write it";
  }
  if (!failure.empty() && !std::exchange(m_isWarned, true))
    m_warn(failure + " (the render goes on without this film)");
  m_due = m_watch.seconds() + std::min(cost.seconds() / share, longest);
}

void Checkpoint::write(const RenderResult& result) {
  if (result.counters.paths == m_paths)
    return;
  m_outputs.write(m_path, filmContent(result, m_job.options.settings.shard, m_made));
  m_outputs.commit();
  m_paths = result.counters.paths;
}

} // namespace fenestra
