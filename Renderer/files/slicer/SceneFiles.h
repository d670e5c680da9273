#pragma once
// The files of a Slicer scene: beside a .mrml, or inside a .mrb.

#include "base/Error.h"
#include "io/Folders.h"
#include "io/InputRegistry.h"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace fenestra {

class SceneArchive;

/// True for .mrml and .mrb, in either case.
bool isSceneFile(const std::filesystem::path& path);

/// Undoes the six escapes of vtkMRMLNode::URLEncodeString.
std::string decodeUrl(std::string text);

class SceneFiles {
public:
  /// Opens a .mrml or a .mrb. An archive's scene is the .mrml closest to its root; of several as
  /// close, the one named like the archive or like its own folder. Throws Error (input).
  explicit SceneFiles(const std::filesystem::path& path);
  ~SceneFiles();

  /// Name of the scene in messages: the .mrml, or the archive.
  const std::string& source() const { return m_source; }
  /// The content of the .mrml.
  const std::string& sceneText() const { return m_sceneText; }

  /// Path at which the file that a storage node names can be read: URL escapes undone, relative to
  /// the .mrml. Unpacks an archive's file at the first call, with the files that this file names;
  /// refuses names that lead out of an archive. Throws Error (input) where there is no such file.
  std::filesystem::path locate(const std::string& fileName);
  /// Enters a file that the scene names, and the files that this file names, into the ledger of
  /// inputs, read or not: no result may replace a part of a scene.
  void registerInputs(const std::string& fileName) const;
  /// True if locate would find the file.
  bool contains(const std::string& fileName) const;

  /// Starts a new list of files read.
  void resetUsedFiles() { m_usedFiles.clear(); }
  /// Names of the scene and of the files located since resetUsedFiles(), as the user knows them.
  std::vector<std::string> usedFiles() const;

  /// Result of `reader` on the located paths of these files, with errors as in knowingly. Throws
  /// Error (input) as locate does.
  template <typename Reader>
  auto read(const std::vector<std::string>& fileNames, Reader&& reader) {
    std::vector<std::filesystem::path> paths;
    for (const std::string& fileName : fileNames)
      paths.push_back(locate(fileName));
    return translateErrors([&] {
      std::optional<InputConfinement> confined;
      if (m_unpackFolder) // an archive's files may name only files in it
        confined.emplace(m_unpackFolder->path());
      return reader(paths);
    });
  }
  /// Result of `work`; its errors name located files as the user knows them.
  template <typename Work>
  auto translateErrors(Work&& work) const {
    try {
      return work();
    } catch (const Error& error) {
      throw Error(error.kind(), translatePaths(error.what()));
    }
  }
  /// Message with paths of unpacked files replaced by names that the user knows, on one line.
  std::string translatePaths(std::string message) const;

private:
  std::filesystem::path resolve(const std::string& fileName) const;
  /// Path of one of the archive's files, unpacked at the first call.
  std::filesystem::path unpack(const std::filesystem::path& file);

  std::string m_source;
  std::string m_sceneText;
  std::filesystem::path m_folder; ///< folder of the .mrml; for a .mrb, within the archive
  std::unique_ptr<SceneArchive> m_archive;
  std::optional<PrivateFolder> m_unpackFolder;
  std::map<std::filesystem::path, std::filesystem::path>
      m_unpackedFiles;                         ///< unpacked files, by name
  std::set<std::filesystem::path> m_usedFiles; ///< names, escapes undone
};

} // namespace fenestra
