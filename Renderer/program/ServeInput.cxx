#include "program/ServeInput.h"

#include "base/Error.h"
#include "files/appearance/LightReader.h"
#include "io/JsonNode.h"
#include "io/MessageText.h"
#include "program/CommandLine.h"
#include "program/ErrorAdvice.h"
#include "program/MergedOptions.h"
#include "program/Quality.h"
#include "program/Stop.h"
#include "program/UsageError.h"
#include "scene/NamedPresets.h"

#include <cstdio>
#include <set>
#include <thread>
#include <utility>

namespace fenestra::core {
namespace {

using nlohmann::json;

constexpr std::size_t longestLine = 1 << 20;

/// Value as command-line text.
std::string toOptionText(const std::string& name, const json& value) {
  if (value.is_string())
    return value.get<std::string>();
  if (value.is_number())
    return value.dump();
  throw usageError(name + ": expected a text, a number or a list of them");
}

/// Items separated by commas; commas in items are escaped.
std::string toOptionList(const std::string& name, const json& list) {
  return join(list, ",", [&name](const json& item) {
    return replaceAll(toOptionText(name, item), ",", "\\,");
  });
}

} // namespace

void writeEvent(const nlohmann::ordered_json& content) {
  static std::mutex mutex;
  const std::string line = dumpJson(content, -1);
  const std::lock_guard lock(mutex);
  if (std::fwrite(line.data(), 1, line.size(), stdout) == line.size() && std::fflush(stdout) == 0)
    return;
  std::fputs("fenestra: standard output was closed\n", stderr);
  endProcess(exitStatus(ErrorKind::output));
}

void writeErrorEvent(const json& id, const Message& message) {
  writeEvent({{"event", "error"},
              {"id", id},
              {"message", composeMessage(message)},
              {"code", toString(message.code)}});
}

json readId(const json& change) {
  constexpr std::size_t longest = 256;
  json id = change.is_object() ? change.value("id", json()) : json();
  const bool isShort = id.is_string() && id.get_ref<const std::string&>().size() <= longest;
  if (!id.is_null() && !id.is_number() && !isShort)
    throw usageError("id: must be a number, a text of at most 256 bytes, or null");
  return id;
}

bool isPause(const json& change) {
  if (!change.is_object() || !change.contains("pause"))
    return false;
  if (change.size() > 1 || change["pause"] != true)
    throw usageError("pause: must be alone and true, as {\"pause\": true}");
  return true;
}

OptionValues applyChange(const json& change, const OptionValues& values) {
  if (!change.is_object())
    throw usageError("expected a JSON object of options, as {\"view\": \"left\"}");
  OptionValues result = values;
  if (const auto quality = change.find("quality"); quality != change.end() && !quality->is_null())
    removeQualityOptions(result);
  std::set<std::string> names;
  for (const auto& [name, value] : change.items()) {
    if (name == "id")
      continue;
    const Option* option = findOption(renderSyntax.options, name);
    if (!option) {
      const std::string likely = findLikelyOption(name, renderSyntax.options);
      throw usageError(toOneLine(name), ": unknown option",
                       likely.empty() ? "" : concat("; did you mean ", likely, "?"));
    }
    if (!isImageOption(*option))
      throw usageError(name, ": cannot change while serving; start another server");
    if (!names.insert(option->name).second)
      throw usageError(name, ": given more than once; give it once");
    result.remove(option->name);
    if (option->spec.canRepeat && value.is_array()) {
      for (const json& item : value)
        result.add(option->name, toOptionText(name, item));
      continue;
    }
    const std::string text = value.is_null()    ? ""
                             : value.is_array() ? toOptionList(name, value)
                                                : toOptionText(name, value);
    if (!text.empty())
      result.add(option->name, text);
  }
  return result;
}

void checkChange(const json& change, const OptionValues& values, const Input& input) {
  const RenderRequest scene = makeRenderOptions(mergePreset(values, input)).scene;
  const bool isPreset = change.contains("preset"); // may set lights and a transfer function
  if (isPreset || change.contains("lights"))
    findLights(scene.lightsName());
  if (scene.transfer && (isPreset || change.contains("transfer")))
    findTransfer(*scene.transfer, input);
  if (scene.materials && (isPreset || change.contains("materials")))
    findMaterials(*scene.materials);
  if (scene.environmentMap && change.contains("environment"))
    readEnvironmentMap(*scene.environmentMap);
}

ServeInput::ServeInput(const OptionValues& start, const Input& input, RenderMonitor& monitor)
    : m_input(input), m_monitor(monitor), m_requested(start) {
  std::thread([this] { read(); }).detach(); // runs until the process ends
}

ServeChanges ServeInput::next() {
  std::unique_lock lock(m_mutex);
  m_changed.wait(lock, [&] { return !m_pending.empty() && !m_isPaused; });
  m_monitor.stop = false;
  return std::exchange(m_pending, {});
}

void ServeInput::revert(const OptionValues& shown) {
  const std::lock_guard lock(m_mutex);
  m_requested = shown;
  for (const ServeChange& change : m_pending)
    m_requested = applyChange(change.options, m_requested);
}

void ServeInput::read() {
  std::string line;
  for (int c = std::getchar(); c != EOF; c = std::getchar()) {
    if (c != '\n') {
      if (line.size() <= longestLine)
        line += static_cast<char>(c);
      continue;
    }
    if (line.size() > longestLine)
      writeErrorEvent(nullptr,
                      makeMessage(ErrorCode::limitExceeded, "a line",
                                  "has more than a million characters; send shorter ones"));
    else if (line.find_first_not_of(" \t\r") != std::string::npos)
      handleLine(line);
    line.clear();
  }
  endProcess(0);
}

void ServeInput::handleLine(const std::string& line) {
  ServeChange change;
  try {
    change.options = parseJson(line, "a line");
    change.id = readId(change.options);
    const std::lock_guard lock(m_mutex);
    if (isPause(change.options)) {
      m_isPaused = true;
      m_monitor.stop = true;
      return;
    }
    OptionValues requested = applyChange(change.options, m_requested);
    checkChange(change.options, requested, m_input);
    m_requested = std::move(requested);
    m_pending.push_back(change);
    m_isPaused = false;
    m_monitor.stop = true;
  } catch (const Error& error) {
    writeErrorEvent(change.id, error.message());
  }
  m_changed.notify_one();
}

} // namespace fenestra::core
