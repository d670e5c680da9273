// `fenestra serve`: a scene stays loaded, changes come in, pictures go out. What a change does not
// touch is not made again (Scene::changed), and the render under way gives way to it.

#include "cli/CommandLine.h"
#include "cli/Commands.h"
#include "cli/Machine.h"
#include "cli/Pictures.h"
#include "cli/PresetFlags.h"
#include "cli/SceneFlags.h"
#include "cli/ServeInput.h"
#include "core/Error.h"
#include "core/Stopwatch.h"

#include <set>

namespace fenestra {
namespace {

const CommandSyntax serveSyntax = {
    "serve",
    "Keeps a scene loaded and renders it anew after every change, for previews. Changes are JSON "
    "objects of flags on standard input, a line each, as {\"id\": 7, \"view\": \"left\", "
    "\"focus\": [\"Femur\", \"Tibia\"]}; null takes a flag back. Every refreshed picture replaces "
    "the output files at once and is told on standard output, as are errors: {\"event\": "
    "\"picture\" or \"error\", \"id\": 7, ...}. Ends with its input.",
    renderSyntax.positionals,
    renderSyntax.flags,
};

/// Nobody reads our answers: nobody wants pictures.
struct Unheard {};

class Server {
public:
  Server(const FlagValues& flags, Outputs& outputs)
      : m_shown{flags}, m_outputs(outputs), m_input(flags, m_monitor, m_answers) {}

  /// Until the process ends, or nobody listens. Throws Error where there is no first scene.
  void run() {
    m_options = renderOptions(withPreset(m_shown.flags));
    m_scene.emplace(m_options->scene);
    m_outputs.checkInputs();
    ServeWish wish = m_shown;
    for (;;) {
      renderPictures();
      do
        wish = m_input.next(wish.number);
      while (!change(wish));
    }
  }

private:
  /// Makes the scene that is wanted. Where that cannot be, the one before stays; returns whether
  /// there is something to render.
  bool change(const ServeWish& wish) {
    try {
      const RenderOptions options = renderOptions(withPreset(wish.flags));
      checkMemory(options.scene);
      Scene scene = m_scene->changed(options.scene);
      m_outputs.checkInputs();
      m_scene = std::move(scene);
      m_options = options;
      m_shown = wish;
      return true;
    } catch (const Error& error) {
      m_outputs.forgetRefused();
      if (!m_answers.error(wish.id, error.what()))
        throw Unheard();
      m_input.takeBack(wish, m_shown.flags);
      return !m_complete;
    }
  }

  void renderPictures() {
    m_complete = false;
    m_monitor.noise = infinity;
    m_monitor.paths = 0;
    m_published.reset();
    m_monitor.between = [this](const RenderResult& result) { publishIfDue(result); };
    const RenderResult result =
        render(m_scene->forRender(), settingsFor(*m_options, m_scene->background()), m_monitor);
    m_complete = result.reason != StopReason::request;
    if (m_complete)
      publish(result, true);
  }

  /// The first at once, others not more often than anybody looks.
  void publishIfDue(const RenderResult& result) {
    constexpr double interval = 0.1; // seconds
    if (m_monitor.stop || (m_published && m_published->seconds() < interval))
      return;
    publish(result, false);
  }

  void publish(const RenderResult& result, bool last) {
    try {
      writePictures(*m_options, *m_scene, result,
                    shellCommand(m_shown.flags.arguments(), *m_options), m_outputs);
      m_outputs.commit(Outputs::Durability::none); // another one follows soon
    } catch (const Error& error) {                 // as of a disk that is full now
      m_published.emplace();
      if (!m_answers.error(m_shown.id, error.what()))
        throw Unheard();
      return;
    }
    nlohmann::ordered_json answer = {{"event", "picture"}, {"id", m_shown.id}};
    answer["samples"] = result.finishedSamples;
    const double noise = result.film.noise();
    answer["noise"] = noise < infinity ? nlohmann::ordered_json(noise) : nullptr;
    answer["seconds"] = m_shown.since.seconds();
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

  ServeWish m_shown; ///< what the scene is of
  Outputs& m_outputs;
  RenderMonitor m_monitor;
  ServeAnswers m_answers;
  ServeInput m_input;
  std::optional<RenderOptions> m_options;
  std::optional<Scene> m_scene;
  bool m_complete = false;              ///< the scene's picture
  std::optional<Stopwatch> m_published; ///< since the last picture of this scene
  std::set<std::string> m_warned;
};

} // namespace

int serveCommand(int argc, char** argv, int first) {
  const std::optional<FlagValues> given = parseCommandLine(serveSyntax, argc, argv, first);
  if (!given)
    return 0;
  for (const char* name : {"stats", "returnparameterfile", "progress", "xml", "echo"})
    if (given->has(name))
      throw usageError(std::string("--") + name + ": serve tells all on standard output; drop it");
  if (given->has("surface"))
    throw usageError("--surface: serve writes pictures alone; write it with fenestra render");
  const FlagValues flags = withSceneFlags(*given);
  const RenderOptions options = renderOptions(withPreset(flags));
  const MachineUse machine(options.settings);
  // Both live as long as the process, as its reading thread does.
  Outputs& outputs = *new Outputs;
  declareOutputs(options, outputs);
  checkMemory(options.scene);
  Server& server = *new Server(flags, outputs);
  try {
    server.run();
  } catch (const Unheard&) {
    throw outputError("standard output", "nobody reads it any more");
  }
  return 0;
}

} // namespace fenestra
