#pragma once
// Manifest of the finished items of a long task (frames of a turntable, a row of a batch), a file
// beside them: request, sizes and times of inputs, size and digest of each result. It is the only
// state of the task. The same command resumes; another one cannot mix its items with these.

#include "io/JsonNode.h"
#include "io/Outputs.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace fenestra::core {

class Manifest {
public:
  /// Finished item.
  struct Item {
    nlohmann::json files; ///< name, bytes and digest of each
    nlohmann::json extra; ///< additional members of its entry; null: none
  };
  using WrittenFiles = std::vector<std::pair<std::filesystem::path, ContentDigest>>;
  using ListFiles = std::function<std::vector<std::filesystem::path>(int item)>;

  /// `itemKey`: name of an item in file and messages, as "frame". `arguments`: those that the items
  /// depend on, with file names relative to the manifest's folder.
  Manifest(std::filesystem::path path, std::string itemKey,
           const std::vector<std::string>& arguments);

  const std::filesystem::path& path() const { return m_path; }
  std::filesystem::path folder() const { return m_path.parent_path(); }

  /// Adds a member to the request, beside version and arguments.
  void addRequest(const std::string& key, const nlohmann::json& value) { m_request[key] = value; }
  /// Adds names, sizes and modification times of the input files to the request, which reveal a
  /// replaced file.
  void addInputs(const std::set<std::filesystem::path>& files);

  /// Reads the request from the file. The file is untrusted: at most the size of a manifest of
  /// `mostFiles` files is read. Throws Error (input), naming file and field, if it is damaged.
  void readRequest(int mostFiles);
  bool hasRequest() const { return !m_recorded.is_null(); }
  /// Input files that the stored request names.
  std::set<std::filesystem::path> recordedInputs() const;
  /// First difference between the stored request and this one, of the members that this one has so
  /// far; nullopt: none, or nothing was read.
  std::optional<std::string> findDifference() const;

  /// Reads the finished items, numbered from 0 to `count` - 1, after readRequest(). Items with
  /// missing files are skipped. `readExtra` checks and returns additional members of an entry.
  /// Throws Error: usage if a file differs from its entry; input for a damaged manifest.
  void readItems(int count, const ListFiles& listFiles,
                 const std::function<nlohmann::json(const JsonNode& entry)>& readExtra);
  /// Files that the stored manifest names and whose sizes are unchanged.
  std::set<std::filesystem::path> recordedFiles() const;

  const std::map<int, Item>& finished() const { return m_finished; }
  void clearItems() { m_finished.clear(); }

  /// Throws the errors of Outputs. A manifest of any version may be replaced.
  void declare(Outputs& outputs) const;
  /// Writes the manifest. Call before the first item, since an item without a manifest could belong
  /// to any command. Throws Error (output).
  void write(Outputs& outputs) const;
  /// Adds an item whose files are in place, with their sizes and digests, which reveal damaged or
  /// replaced files. Throws Error (output).
  void finish(int item, const WrittenFiles& files, const nlohmann::json& extra, Outputs& outputs);

private:
  std::filesystem::path m_path;
  std::string m_itemKey;
  nlohmann::json m_document; ///< content of the file
  nlohmann::json m_request;
  nlohmann::json m_recorded; ///< stored request; null: not read
  std::map<int, Item> m_finished;
};

} // namespace fenestra::core
