#pragma once
// Files of a Slicer scene, beside a .mrml or inside a .mrb. Only this class knows where they are.
// It unpacks archived files on demand.
#include "base/Error.h"
#include "io/InputRegistry.h"
#include "io/platform/Folders.h"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace fenestra::core {

class SceneArchive;

/// True for .mrml and .mrb, case-insensitive.
bool isSceneFile(const std::filesystem::path& path);

/// Decodes the six escapes of vtkMRMLNode::URLEncodeString.
std::string decodeUrl(std::string text);

class SceneFiles {
public:
  /// Opens a .mrml or a .mrb. The scene of an archive is the .mrml closest to its root. If several
  /// are equally close, it is the one named like the archive or like its own folder. Throws Error
  /// (input).
  explicit SceneFiles(const std::filesystem::path& path);
  ~SceneFiles();

  /// Name of the scene in messages: the .mrml or the archive.
  const std::string& source() const { return m_source; }
  /// The content of the .mrml.
  const std::string& sceneText() const { return m_sceneText; }

  /// Path at which a file that a storage node names can be read; the name is URL-decoded and
  /// relative to the .mrml. The first call unpacks an archived file and the files that it
  /// references. Throws Error (input) if the file does not exist or lies outside the archive.
  std::filesystem::path locate(const std::string& fileName);
  /// Registers a file that the scene names, and the files that it references, as inputs, whether
  /// they are read or not. No output may replace a part of a scene.
  void registerInputs(const std::string& fileName) const;
  /// True if locate would find the file.
  bool contains(const std::string& fileName) const;

  /// Clears the list of used files.
  void resetUsedFiles() { m_usedFiles.clear(); }
  /// The scene and the files located since resetUsedFiles(), by the names that the user knows.
  std::vector<std::string> usedFiles() const;

  /// Calls `reader` with the located paths of these files and returns its result. Translates errors
  /// as translateErrors does. Throws Error (input) as locate does.
  template <typename Reader>
  auto read(const std::vector<std::string>& fileNames, Reader&& reader) {
    std::vector<std::filesystem::path> paths;
    for (const std::string& fileName : fileNames)
      paths.push_back(locate(fileName));
    return translateErrors([&] {
      std::optional<InputConfinement> confined;
      if (m_unpackFolder) // archived files may only reference files of the archive
        confined.emplace(m_unpackFolder->path());
      return reader(paths);
    });
  }
  /// Returns the result of `work`; errors name unpacked files as the user knows them.
  template <typename Work>
  auto translateErrors(Work&& work) const {
    try {
      return work();
    } catch (const Error& error) {
      throw Error(error.kind(), translatePaths(error.message()));
    }
  }
  /// Replaces paths of unpacked files in a text by names that the user knows; one line.
  std::string translatePaths(std::string text) const;
  Message translatePaths(const Message& message) const {
    return {message.code, translatePaths(message.subject), translatePaths(message.detail)};
  }

private:
  std::filesystem::path resolve(const std::string& fileName) const;
  /// Path of an archived file, unpacked at the first call.
  std::filesystem::path unpack(const std::filesystem::path& file);

  std::string m_source;
  std::string m_sceneText;
  std::filesystem::path m_folder; ///< folder of the .mrml; in a .mrb, relative to the archive
  std::unique_ptr<SceneArchive> m_archive;
  std::optional<PrivateFolder> m_unpackFolder;
  std::map<std::filesystem::path, std::filesystem::path>
      m_unpackedFiles;                         ///< unpacked paths, by name
  std::set<std::filesystem::path> m_usedFiles; ///< decoded names
};

} // namespace fenestra::core
