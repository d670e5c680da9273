// `fenestra merge`: parts of a picture (render --shard) as the picture that one machine would have
// made. The scene is made again, from the flags that the parts record: for the filter's features,
// the clip's surface and its measures.

#include "base/Error.h"
#include "io/JsonNode.h"
#include "program/CommandLine.h"
#include "program/Commands.h"
#include "program/RenderCommand.h"

#include <algorithm>

namespace fenestra {
namespace {

namespace fs = std::filesystem;

/// True for flags of a picture that is rendered already.
bool isMergeOption(const Option& option) {
  constexpr std::string_view others[] = {
      "checkpoint", "shard", "xml", "echo", "returnparameterfile", "processinformationaddress"};
  return !isSampleOption(option) && option.overrideGroup != OverrideGroup::stop &&
         std::ranges::find(others, option.name) == std::end(others);
}

/// Throws Error (usage) unless both are parts of one picture with the same samples.
void requireSameImage(const CheckpointFile& one, const CheckpointFile& other) {
  const auto refuse = [&](const std::string& what) {
    return usageError(other.path(), ": ", what, "; merge parts of one picture");
  };
  if (one.shard().count != other.shard().count)
    throw refuse(concat("is part ", formatShard(other.shard()), ", and ", one.path(), " is ",
                        formatShard(one.shard())));
  for (const char* key : {"version", "settings", "inputs"}) {
    const nlohmann::json here = {
        {key, JsonNode(other.metadata(), other.path().string()).at(key).value()}};
    const std::string difference = findDifference(one.metadata(), here, one.path().string());
    if (!difference.empty())
      throw refuse(concat("is not of the picture of ", one.path(), ": ", difference));
  }
  if (one.target() != other.target())
    throw refuse(
        concat("has samples by ", other.target(), ", and ", one.path(), " by ", one.target()));
  if (one.finishedSamples() != other.finishedSamples())
    throw usageError(other.path(), ": has ", other.finishedSamples(), " samples a pixel, and ",
                     one.path(), " has ", one.finishedSamples(),
                     "; run the command of the lesser one to its end");
}

/// Films in the order of their parts. Throws Error: usage where one is missing, doubled, not
/// finished, or of another picture; input where one is damaged.
std::vector<CheckpointFile> readShards(const std::vector<std::string>& names) {
  std::vector<CheckpointFile> films;
  for (const std::string& name : names) {
    const CheckpointFile& film = films.emplace_back(name);
    requireSameImage(films.front(), film);
    if (film.finishedSamples() == 0 || film.begunSamples() != film.finishedSamples())
      throw usageError(film.path(), ": is not finished; run its command again");
  }
  std::ranges::sort(films, {}, [](const CheckpointFile& film) { return film.shard().index; });
  const auto twice = std::ranges::adjacent_find(
      films, {}, [](const CheckpointFile& film) { return film.shard().index; });
  if (twice != films.end())
    throw usageError(twice->path(), ": is part ", formatShard(twice->shard()), ", as is ",
                     std::next(twice)->path(), "; drop one");
  std::vector<int> missing;
  const int count = films.front().shard().count;
  for (int index = 0; index < count; ++index)
    if (std::ranges::none_of(films, [&](const auto& film) { return film.shard().index == index; }))
      missing.push_back(index + 1);
  constexpr std::size_t mostNamed = 10;
  if (!missing.empty())
    throw usageError("PART: of ", count, " parts, number ",
                     join(
                         missing, ", ", [](int i) { return concat(i); }, mostNamed),
                     missing.size() == 1 ? " is" : " are", " missing; add ",
                     missing.size() == 1 ? "it" : "them");
  return films;
}

/// Flags with which a film was rendered, whose names of files are relative to the film. Throws
/// Error (input).
OptionValues readRenderOptions(const CheckpointFile& film) {
  OptionValues options(renderSyntax.options);
  const JsonNode given = JsonNode(film.metadata(), film.path().string()).at("given");
  const fs::path folder = film.path().parent_path();
  for (const auto& [name, values] : given.members()) {
    const Option* const option = findOption(renderSyntax.options, name);
    if (name != "INPUT" && !(option && isImageOption(*option)))
      throw given.error("\"" + name + "\" is no flag of a picture; render the film again");
    for (const JsonNode& value : values.elements()) {
      const std::string text = value.text();
      std::error_code failed;
      const fs::path file = (folder / text).lexically_normal();
      const bool isFile = (!option || option->canNameFile()) && fs::exists(file, failed);
      options.add(name, isFile ? file.string() : text);
    }
  }
  if (options.texts("INPUT").size() != 1)
    throw given.error("must have one INPUT; render the film again");
  return options;
}

} // namespace

/// Built on first use: renderSyntax is initialised in another source.
const CommandSyntax& mergeSyntax() {
  static const std::vector<Option> options = [] {
    std::vector<Option> all;
    std::ranges::copy_if(renderSyntax.options, std::back_inserter(all), isMergeOption);
    return all;
  }();
  static const CommandSyntax syntax = {
      "merge",
      "Makes a picture of its parts, which fenestra render --shard K/N has put into films, in any "
      "order: bit for bit the picture that one machine would have made. A single film of "
      "--checkpoint will do as well. The films name the inputs, which are read again.",
      {{.name = "PART",
        .description = "Films (.film), all parts of one picture",
        .canRepeat = true}},
      options,
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
  RenderSettings& settings = job.options.settings; // nothing is left to render
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

} // namespace fenestra
