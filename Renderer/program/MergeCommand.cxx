// `fenestra merge`: joins the shards of an image (render --shard), bit for bit as in one run. The
// scene is built again from the options that the shards store, since denoising, clipping
// surface and measures need it.

#include "base/Error.h"
#include "io/JsonNode.h"
#include "program/CommandLine.h"
#include "program/Commands.h"
#include "program/RenderCommand.h"
#include "program/UsageError.h"

#include <algorithm>

namespace fenestra::core {
namespace {

namespace fs = std::filesystem;

/// True for options that apply to an image whose samples exist already.
bool isMergeOption(const Option& option) {
  constexpr std::string_view others[] = {
      "checkpoint", "shard", "xml", "echo", "returnparameterfile", "processinformationaddress"};
  return !isSampleOption(option) && option.overrideGroup != OverrideGroup::stop &&
         std::ranges::find(others, option.name) == std::end(others);
}

/// Throws Error (usage) unless both are shards of one image with the same number of samples.
void requireSameImage(const CheckpointFile& one, const CheckpointFile& other) {
  const auto refuse = [&](const std::string& what) {
    return usageError(other.path(), ": ", what, "; merge shards of one image");
  };
  if (one.shard().count != other.shard().count)
    throw refuse(concat("is shard ", formatShard(other.shard()), ", but ", one.path(), " is ",
                        formatShard(one.shard())));
  for (const char* key : {"version", "settings", "inputs"}) {
    const nlohmann::json here = {
        {key, JsonNode(other.metadata(), other.path().string()).at(key).value()}};
    const std::string difference = findDifference(one.metadata(), here, one.path().string());
    if (!difference.empty())
      throw refuse(concat("belongs to another image than ", one.path(), ": ", difference));
  }
  if (one.target() != other.target())
    throw refuse(
        concat("was rendered by ", other.target(), ", but ", one.path(), " by ", one.target()));
  if (one.finishedSamples() != other.finishedSamples())
    throw usageError(other.path(), ": has ", other.finishedSamples(), " samples per pixel, but ",
                     one.path(), " has ", one.finishedSamples(),
                     "; resume the one with fewer samples");
}

/// Checkpoint files in the order of their shards. Throws Error: usage if one is missing, duplicate,
/// unfinished, or of another image; input if one is damaged.
std::vector<CheckpointFile> readShards(const std::vector<std::string>& names) {
  std::vector<CheckpointFile> films;
  for (const std::string& name : names) {
    const CheckpointFile& film = films.emplace_back(name);
    requireSameImage(films.front(), film);
    if (film.finishedSamples() == 0 || film.begunSamples() != film.finishedSamples())
      throw usageError(film.path(), ": is unfinished; run its render command again");
  }
  std::ranges::sort(films, {}, [](const CheckpointFile& film) { return film.shard().index; });
  const auto twice = std::ranges::adjacent_find(
      films, {}, [](const CheckpointFile& film) { return film.shard().index; });
  if (twice != films.end())
    throw usageError(twice->path(), ": is shard ", formatShard(twice->shard()), ", as is ",
                     std::next(twice)->path(), "; omit one");
  std::vector<int> missing;
  const int count = films.front().shard().count;
  for (int index = 0; index < count; ++index)
    if (std::ranges::none_of(films, [&](const auto& film) { return film.shard().index == index; }))
      missing.push_back(index + 1);
  constexpr std::size_t mostNamed = 10;
  if (!missing.empty())
    throw usageError("PART: of ", count, " shards, number ",
                     join(
                         missing, ", ", [](int i) { return concat(i); }, mostNamed),
                     missing.size() == 1 ? " is" : " are", " missing; add ",
                     missing.size() == 1 ? "it" : "them");
  return films;
}

/// Options that a checkpoint file was rendered with. Their file names are relative to it. Throws
/// Error (input).
OptionValues readRenderOptions(const CheckpointFile& film) {
  OptionValues options(renderSyntax.options);
  const JsonNode given = JsonNode(film.metadata(), film.path().string()).at("given");
  const fs::path folder = film.path().parent_path();
  for (const auto& [name, values] : given.members()) {
    const Option* const option = findOption(renderSyntax.options, name);
    if (name != "INPUT" && !(option && isImageOption(*option)))
      throw given.error("\"" + name + "\" is not an option of an image; render the shard again");
    for (const JsonNode& value : values.elements()) {
      const std::string text = value.text();
      std::error_code failed;
      const fs::path file = (folder / text).lexically_normal();
      const bool isFile = (!option || option->canNameFile()) && fs::exists(file, failed);
      options.add(option ? option->name : name, isFile ? file.string() : text);
    }
  }
  if (options.texts("INPUT").size() != 1)
    throw given.error("must have one INPUT; render the shard again");
  return options;
}

} // namespace

/// Built on first use, since renderSyntax is initialized in another source file.
const CommandSyntax& mergeSyntax() {
  static const std::vector<Option> options = [] {
    std::vector<Option> all;
    std::ranges::copy_if(renderSyntax.options, std::back_inserter(all), isMergeOption);
    return all;
  }();
  static const CommandSyntax syntax = {
      "merge",
      "Joins the shards of an image, which fenestra render --shard K/N has written to checkpoint "
      "files, in any order: bit for bit the image of a single run. A single file of --checkpoint "
      "can be merged, too. The checkpoint files name the inputs, which are read again.",
      {{.name = "PART",
        .description = "All checkpoint files (.film) of one image",
        .canRepeat = true}},
      options,
      {},
      "Join the shards of an image that were rendered separately",
      "merge part1.film part2.film -o knee.png",
  };
  return syntax;
}

int mergeCommand(int argc, char** argv, int first) {
  const std::optional<OptionValues> given = parseCommandLine(mergeSyntax(), argc, argv, first);
  if (!given)
    return 0;
  configureMachine(*given);
  std::vector<CheckpointFile> films = readShards(given->texts("PART"));
  OptionValues options = readRenderOptions(films.front());
  for (const Option& option : mergeSyntax().options)
    if (given->has(option.name)) {
      options.remove(option.name);
      for (const std::string& value : given->texts(option.name))
        options.add(option.name, value);
    }
  RenderJob job = makeRenderJob(options);
  RenderSettings& settings = job.options.settings; // such that no samples are added
  settings.samples = films.front().finishedSamples();
  settings.seconds = infinity;
  settings.noise = -1.0;
  job.options.noiseTarget = NoiseTarget::raw;
  std::optional<Checkpoint> checkpoint;
  checkpoint.emplace(job, options, std::move(films));
  Outputs outputs;
  declareOutputs(job.options, outputs);
  checkMemory(job.options.scene);
  return renderScene(job, options.arguments(), checkpoint, outputs);
}

} // namespace fenestra::core
