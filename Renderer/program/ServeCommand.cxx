// `fenestra serve`: a scene stays loaded, changes come in, pictures go out. Stages that a change
// does not touch are not rebuilt (Scene::changed), and a change stops the render under way.

#include "base/Error.h"
#include "base/Stopwatch.h"
#include "program/CommandLine.h"
#include "program/Commands.h"
#include "program/Machine.h"
#include "program/Pictures.h"
#include "program/PresetFlags.h"
#include "program/SceneFlags.h"
#include "program/ServeInput.h"

#include <set>
#include <span>

namespace fenestra {
namespace {

/// Built on first use: renderSyntax is initialised in another source.
const CommandSyntax& serveSyntax() {
  static const CommandSyntax syntax = {
      "serve",
      "Keeps a scene loaded and renders it anew after every change, for previews. Changes are JSON "
      "objects of flags on standard input, a line each, as {\"id\": 7, \"view\": \"left\", "
      "\"focus\": [\"Femur\", \"Tibia\"]}; null takes a flag back. Every refreshed picture "
      "replaces "
      "the output files at once and is told on standard output, as are errors: {\"event\": "
      "\"picture\" or \"error\", \"id\": 7, ...}. Ends with its input.",
      renderSyntax.positionals,
      renderSyntax.flags,
  };
  return syntax;
}

/// Thrown when standard output is closed: nobody waits for pictures.
struct Unheard {};

class Server {
public:
  Server(const SceneFlags& start, const Input& source, Outputs& outputs)
      : m_source(source),
        m_flags(start.flags),
        m_leftOut(start.leftOut),
        m_outputs(outputs),
        m_input(m_flags, source, m_monitor, m_answers) {}

  /// Runs until the process ends. Throws Error if there is no first scene, Unheard if standard
  /// output is closed.
  void run() {
    m_options = renderOptions(withPreset(m_flags, m_source));
    m_options->scene.leftOut = m_leftOut;
    m_scene.emplace(m_options->scene, m_source);
    m_outputs.checkInputs();
    for (;;) {
      renderPictures();
      do {
        const ServeChanges changes = m_input.next();
        if (!take(changes))
          m_input.takeBack(m_flags);
      } while (m_complete);
    }
  }

private:
  /// Builds the scene of all changes together. If that fails, tries each half separately, down to
  /// single changes; a single change that fails is answered with the error and has no effect.
  /// Returns whether all changes were taken together.
  bool take(std::span<const ServeChange> changes) {
    try {
      FlagValues flags = m_flags;
      for (const ServeChange& change : changes)
        flags = changedFlags(change.flags, flags);
      const RenderOptions options = renderOptions(withPreset(flags, m_source));
      checkMemory(options.scene);
      Scene scene = m_scene->changed(options.scene);
      m_outputs.checkInputs();
      m_scene = std::move(scene);
      m_options = options;
      m_flags = flags;
      m_id = changes.back().id;
      m_since = changes.back().since;
      m_complete = false;
      return true;
    } catch (const Error& error) {
      m_outputs.forgetRefused();
      if (changes.size() == 1 && !m_answers.error(changes.front().id, error.what()))
        throw Unheard();
    }
    if (changes.size() > 1) {
      take(changes.first(changes.size() / 2));
      take(changes.subspan(changes.size() / 2));
    }
    return false;
  }

  void renderPictures() {
    m_complete = false;
    m_monitor.noise = infinity;
    m_monitor.paths = 0;
    m_published.reset();
    m_failure.clear();
    m_monitor.between = [this](const RenderResult& result) { publishIfDue(result); };
    const RenderResult result =
        render(m_scene->forRender(), settingsFor(*m_options, m_scene->background()), m_monitor);
    m_complete = result.reason != StopReason::request;
    if (m_complete)
      publish(result, true);
  }

  /// Publishes the first picture at once, later ones at most every `interval`.
  void publishIfDue(const RenderResult& result) {
    constexpr double interval = 0.1; // seconds
    if (m_monitor.stop || (m_published && m_published->seconds() < interval))
      return;
    publish(result, false);
  }

  /// Returns whether the files are written. A failure (a full disk) is reported, for intermediate
  /// pictures only once each; the next picture may have room again.
  bool write(const RenderResult& result, bool last) {
    try {
      writePictures(*m_options, *m_scene, result, shellCommand(m_flags.arguments(), *m_options),
                    m_outputs);
      m_outputs.commit(Outputs::Durability::none); // the next picture follows soon
      return true;
    } catch (const Error& error) {
      if ((last || m_failure != error.what()) && !m_answers.error(m_id, error.what()))
        throw Unheard();
      m_failure = error.what();
      m_published.emplace();
      return false;
    }
  }

  void publish(const RenderResult& result, bool last) {
    if (!write(result, last))
      return;
    nlohmann::ordered_json answer = {{"event", "picture"}, {"id", m_id}};
    answer["samples"] = result.finishedSamples;
    const double noise = result.film.noise();
    answer["noise"] = noise < infinity ? nlohmann::ordered_json(noise) : nullptr;
    answer["seconds"] = m_since.seconds();
    answer["done"] = last;
    answer["files"] = nlohmann::ordered_json::array();
    for (const std::filesystem::path& path : m_options->outputs)
      answer["files"].push_back(path.string());
    for (const std::string& warning : m_scene->warnings())
      if (m_warned.insert(warning).second)
        answer["warnings"].push_back(warning);
    if (!m_answers.say(answer))
      throw Unheard();
    m_published.emplace();
  }

  const Input m_source; ///< of all scenes
  FlagValues m_flags;   ///< flags of the current scene
  std::vector<std::string> m_leftOut;
  nlohmann::json m_id = nullptr; ///< of the last change taken
  Stopwatch m_since;             ///< time since that change arrived
  Outputs& m_outputs;
  RenderMonitor m_monitor;
  ServeAnswers m_answers;
  ServeInput m_input;
  std::optional<RenderOptions> m_options;
  std::optional<Scene> m_scene;
  bool m_complete = false;              ///< true: the scene's picture is finished
  std::optional<Stopwatch> m_published; ///< time since the scene's last picture; nullopt: none yet
  std::string m_failure;                ///< last reported failure to write a picture of this scene
  std::set<std::string> m_warned;
};

} // namespace

int serveCommand(int argc, char** argv, int first) {
  const std::optional<FlagValues> given = parseCommandLine(serveSyntax(), argc, argv, first);
  if (!given)
    return 0;
  for (const char* name : {"stats", "returnparameterfile", "progress", "xml", "echo"})
    if (given->has(name))
      throw usageError(std::string("--") + name + ": serve tells all on standard output; drop it");
  if (given->has("surface"))
    throw usageError("--surface: serve writes pictures alone; write it with fenestra render");
  useMachine(*given);
  const Input input(*given->text("INPUT"));
  const SceneFlags start = withSceneFlags(*given, input);
  const RenderOptions options = renderOptions(withPreset(start.flags, input));
  // Never destroyed: the reading thread, which lives as long as the process, uses both.
  Outputs& outputs = *new Outputs;
  declareOutputs(options, outputs);
  checkMemory(options.scene);
  Server& server = *new Server(start, input, outputs);
  try {
    server.run();
  } catch (const Unheard&) {
    throw outputError("standard output", "nobody reads it any more");
  }
  return 0;
}

} // namespace fenestra
