#pragma once
// The files of a Slicer scene: beside a .mrml, or inside a .mrb.

#include "base/Error.h"
#include "base/safe/Inputs.h"
#include "base/safe/PrivateFolder.h"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fenestra {

class SceneArchive;

/// True for .mrml and .mrb, in either case.
bool isSceneFile(const std::filesystem::path& path);

/// Undoes the escapes of vtkMRMLNode::URLEncodeString, which are six and no others.
std::string decodedUrl(std::string text);

class SceneFiles {
public:
  /// Opens a .mrml or a .mrb; of an archive the scene is the .mrml closest to its root (of several
  /// as close, the one that is named like the archive or its folder). Throws Error (input).
  explicit SceneFiles(const std::filesystem::path& path);
  ~SceneFiles();

  /// Names the scene in messages: the .mrml, or the archive.
  const std::string& source() const { return m_source; }
  /// The content of the .mrml.
  const std::string& sceneText() const { return m_sceneText; }

  /// Where the file that a storage node names can be read: its URL escapes are undone, and relative
  /// names start at the .mrml. An archive's files are unpacked when they are asked for, with those
  /// that they name; it holds all of its own, so names that lead out of it are refused. Throws
  /// Error (input) where there is no such file.
  std::filesystem::path locate(const std::string& fileName);
  /// Enters a file that the scene names, and those that this one names, into the ledger of inputs,
  /// whether they are read or not: no result may replace what belongs to a scene.
  void expect(const std::string& fileName) const;
  /// Whether locate would find it.
  bool holds(const std::string& fileName) const;

  /// The scene itself and the files that were located, as the user knows them.
  std::vector<std::string> filesRead() const;

  /// What `reader` makes of the paths where these files are, as knowingly does. Throws Error
  /// (input) as locate does.
  template <typename Reader>
  auto read(const std::vector<std::string>& fileNames, Reader&& reader) {
    std::vector<std::filesystem::path> paths;
    for (const std::string& fileName : fileNames)
      paths.push_back(locate(fileName));
    return knowingly([&] {
      std::optional<InputsWithin> within;
      if (m_unpacked) // an archive holds all of its own
        within.emplace(m_unpacked->path());
      return reader(paths);
    });
  }
  /// What `work` with files that were read makes; its errors name them as the user knows them.
  template <typename Work>
  auto knowingly(Work&& work) const {
    try {
      return work();
    } catch (const Error& error) {
      throw Error(error.kind(), asKnown(error.what()));
    }
  }
  /// A message with the places of unpacked files as the user knows them, on one line.
  std::string asKnown(std::string message) const;

private:
  std::filesystem::path resolved(const std::string& fileName) const;
  /// Where one of the archive's files is, unpacked once.
  std::filesystem::path unpacked(const std::filesystem::path& file);

  std::string m_source;
  std::string m_sceneText;
  std::filesystem::path m_folder; ///< of the .mrml, in the archive where there is one
  std::unique_ptr<SceneArchive> m_archive;
  std::optional<PrivateFolder> m_unpacked;
  std::map<std::filesystem::path, std::filesystem::path> m_located; ///< as named, and where it is
};

} // namespace fenestra
