#pragma once
// Registry of every file that a program reads: no result may replace such a file, under any name.
// Every reader calls requireFile before it opens a file.

#include "io/platform/FileStatus.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace fenestra::core {

/// Files that this process has read during the object's life: that of a program (program/Process).
/// At most one exists. Without one, as in programs that use Fenestra as a library, no file is
/// registered: a file may be read, replaced and read again.
class InputRegistry {
public:
  InputRegistry();
  ~InputRegistry();
  InputRegistry(const InputRegistry&) = delete;
  InputRegistry& operator=(const InputRegistry&) = delete;

private:
  std::map<FileId, std::filesystem::path> m_inputs;
};

/// True if a file or folder exists at `path`; isFolder: if it is a folder. Links are followed.
/// Throws Error (input) if the system cannot determine it.
bool fileExists(const std::filesystem::path& path);
bool isFolder(const std::filesystem::path& path);

struct FolderContent {
  std::vector<std::filesystem::path> files, folders; ///< sorted
};
/// Files and folders directly in `folder`; none is registered. Throws Error (input).
FolderContent listFolder(const std::filesystem::path& folder);

/// Registers `path` as an input. Throws Error (input) unless `path` is a readable file of at most
/// `maxBytes` bytes, inside the folder of an InputConfinement if there is one. `hint`: advice in
/// the message if `path` is a folder.
void requireFile(const std::filesystem::path& path, const std::string& hint,
                 std::uint64_t maxBytes = UINT64_MAX);

/// Registers the file at `path`, or the files directly in the folder at `path`, as inputs; no
/// effect if neither exists. For files that are read later, or that belong to a file that is read.
void registerInput(const std::filesystem::path& path);

/// Confines this thread's reads to `folder` during the object's life, whatever the files in
/// `folder` refer to. For unpacked archives. nullopt: no confinement, for a file that the user
/// names while an archive is read.
class InputConfinement {
public:
  explicit InputConfinement(const std::optional<std::filesystem::path>& folder);
  ~InputConfinement();
  InputConfinement(const InputConfinement&) = delete;
  InputConfinement& operator=(const InputConfinement&) = delete;

private:
  std::optional<std::filesystem::path> m_folder;
  const std::filesystem::path* m_previous;
};

/// Name under which `file` was first read; nullopt: not registered.
std::optional<std::filesystem::path> findInput(const FileId& file);

/// Removes a file from the registry: one that this process has just created (an input that had its
/// inode number is gone), or that is read only to be written again.
void unregisterInput(const FileId& file);

/// The last extension with its dot, in lower case: ".GZ" of "a.nii.GZ" is ".gz".
std::string lowercaseExtension(const std::filesystem::path& path);

} // namespace fenestra::core
