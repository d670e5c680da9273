#include "scene/NamedPresets.h"

#include "base/Error.h"
#include "files/appearance/LightReader.h"
#include "files/slicer/MrmlScene.h"
#include "files/slicer/SlicerPresets.h"
#include "io/EmbeddedResources.h"
#include "io/JsonNode.h"
#include "io/MessageText.h"
#include "io/platform/SystemErrors.h"
#include "scene/SegmentMaterials.h"

#include <optional>

namespace fenestra::core {
namespace {

constexpr const char* inlineTransfer = "transfer function"; ///< source of inline JSON
constexpr const char* inlineLights = "lights";

/// JSON of the built-in preset `name` under Resources/<kind>/; empty if there is none.
std::string_view findBuiltinPreset(const std::string& kind, const std::string& name) {
  return findResource(kind + "/" + name + ".json");
}

std::string joinNames(const std::vector<std::string>& names) {
  return join(names, ", ", [](const std::string& name) { return sanitize(name); });
}

bool isExistingFile(const std::string& name) {
  std::error_code failed;
  return std::filesystem::exists(name, failed);
}

/// Error for an unknown name. A path in an inaccessible folder gets a reading error; any other name
/// might be a misspelled preset.
Error makeUnknownError(const std::string& name, const std::string& known) {
  std::error_code failed;
  if (name.find('/') != std::string::npos && !std::filesystem::exists(name, failed) && failed)
    return readError(name, failed.value(), "check the permissions of its folder");
  return inputError(ErrorCode::unknownName, name, "no such file or preset; expected ", known);
}

/// Volume properties of a scene, by name or id, and the presets of an installed Slicer.
class SlicerTransfers {
public:
  explicit SlicerTransfers(const Input& input) : m_input(input) {
    if (const auto file = findSlicerPresets())
      m_presets.emplace(readText(*file), file->string());
  }

  std::optional<NamedTransfer> find(const std::string& name) {
    if (SceneTransfer stored = m_input.property(name); stored.transfer)
      return NamedTransfer{{std::move(*stored.transfer)}, name, std::move(stored.files)};
    if (m_presets)
      for (const MrmlNode* node : m_presets->findByTag("VolumeProperty"))
        if (node->name == name)
          return NamedTransfer{
              {readInlineProperty(*m_presets, *node)}, name, {m_presets->source()}};
    return std::nullopt;
  }

  /// Lists the known names for a message.
  std::string knownNames() const {
    const std::vector<std::string> inScene = m_input.propertyNames();
    std::string text = inScene.empty() ? "" : "; in the scene: " + joinNames(inScene);
    text += m_presets ? "; in Slicer: " + joinNames(listPropertyNames(*m_presets))
                      : "; set SLICER_HOME to Slicer's folder to use its presets";
    return text;
  }

private:
  const Input& m_input;
  std::optional<MrmlDocument> m_presets; ///< of an installed Slicer
};

} // namespace

std::vector<std::string> listBuiltinPresets(const std::string& kind) {
  std::vector<std::string> names;
  for (const std::string& path : listResources(kind + "/"))
    if (path.ends_with(".json"))
      names.push_back(std::filesystem::path(path).stem());
  return names;
}

bool isFileName(const std::string& kind, const std::string& name) {
  return findBuiltinPreset(kind, name).empty() &&
         (name.find_first_of("/.") != std::string::npos || isExistingFile(name));
}

NamedTransfer findTransfer(const std::string& name, const Input& input) {
  if (isInlineJson(name))
    return {parseTransferJson(name, inlineTransfer), inlineTransfer};
  if (const std::string_view text = findBuiltinPreset("transfer", name); !text.empty())
    return {parseTransferJson(text, name), name};
  if (isExistingFile(name))
    return {readTransferFile(name), name, {name}};
  SlicerTransfers slicer(input);
  if (auto transfer = slicer.find(name))
    return std::move(*transfer);
  throw makeUnknownError(name, "a file or one of " + joinNames(listBuiltinPresets("transfer")) +
                                   slicer.knownNames());
}

bool isTransferFile(const std::string& name, const Input& input) {
  if (isInlineJson(name) || !isFileName("transfer", name))
    return false;
  return name.find('/') != std::string::npos || isExistingFile(name) ||
         !SlicerTransfers(input).find(name);
}

NamedLights findLights(const std::string& name) {
  if (isInlineJson(name))
    return {parseLights(name, inlineLights), inlineLights};
  if (const std::string_view text = findBuiltinPreset("lights", name); !text.empty())
    return {parseLights(text, name), name};
  if (!isExistingFile(name))
    throw makeUnknownError(name, "a file or one of " + joinNames(listBuiltinPresets("lights")));
  return {readLights(name), name, {name}};
}

bool isLightsFile(const std::string& name) {
  return isInlineJson(name) ? hasFileReference(name, inlineLights) : isFileName("lights", name);
}

NamedMaterials findMaterials(const std::string& name,
                             const std::optional<double>& contextSaturation) {
  NamedMaterials materials{materialLibrary(), name};
  if (!isMaterialsFile(name)) {
    materials.table.hasContrast = materials.table.detectsSkin = name == contrastMaterials;
  } else if (isExistingFile(name)) {
    materials.table = parseMaterials(readText(name), name, materials.table);
    materials.files = {name};
  } else {
    throw makeUnknownError(name, "none, library, contrast, or a file");
  }
  if (contextSaturation)
    materials.table.context.saturation = contextSaturation;
  return materials;
}

bool isMaterialsFile(const std::string& name) {
  return name != noMaterials && name != contrastMaterials && name != libraryMaterials;
}

OrganPreset findOrganPreset(const std::string& name) {
  if (const std::string_view text = findBuiltinPreset("presets", name); !text.empty())
    return parsePreset(text, name);
  if (!isExistingFile(name))
    throw makeUnknownError(name,
                           "auto, a file, or one of " + joinNames(listBuiltinPresets("presets")));
  return parsePreset(readText(name), name);
}

} // namespace fenestra::core
