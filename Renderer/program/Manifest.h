#pragma once
// Record of the finished pieces of long work (frames of a turntable, a row of a study), in a file
// beside them: the same command resumes where it was stopped, and another command does not mix its
// pieces with these.

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

namespace fenestra {

class Manifest {
public:
  /// Finished piece.
  struct Item {
    nlohmann::json files; ///< name, bytes and digest of each
    nlohmann::json extra; ///< further members of its entry; null: none
  };
  using WrittenFiles = std::vector<std::pair<std::filesystem::path, ContentDigest>>;
  using ListFiles = std::function<std::vector<std::filesystem::path>(int item)>;

  /// `word`: what a piece is called, in the file and in messages. `arguments`: those on which the
  /// pieces depend, with file names relative to the record's folder.
  Manifest(std::filesystem::path path, std::string itemKey,
           const std::vector<std::string>& arguments);

  const std::filesystem::path& path() const { return m_path; }
  std::filesystem::path folder() const { return m_path.parent_path(); }

  /// Adds a part to the request, beside version and arguments.
  void addRequest(const std::string& key, const nlohmann::json& value) { m_request[key] = value; }
  /// Adds name, size and time of the input files to the request, by which a replaced file is
  /// noticed.
  void addInputs(const std::set<std::filesystem::path>& files);

  /// Reads the request in the file, of untrusted size: at most a record of `mostFiles` files.
  /// Throws Error (input), naming file and field, for a damaged record.
  void readRequest(int mostFiles);
  bool hasRequest() const { return !m_recorded.is_null(); }
  /// Input files that the request read from the file names.
  std::set<std::filesystem::path> recordedInputs() const;
  /// Text of the first difference between the request read from the file and this one, as far as
  /// the latter is known; nullopt: none, or nothing was read.
  std::optional<std::string> findDifference() const;

  /// Reads the finished pieces, of `count`, after readRequest; pieces that miss a file do not
  /// count. `readExtra`: checks and returns the further members of an entry. Throws Error: usage
  /// for a file that is there but not as recorded; input for a damaged record.
  void readItems(int count, const ListFiles& listFiles,
                 const std::function<nlohmann::json(const JsonNode& entry)>& readExtra);
  /// Files that the record read by readRequest names and that still have their sizes.
  std::set<std::filesystem::path> recordedFiles() const;

  const std::map<int, Item>& finished() const { return m_finished; }
  void clearItems() { m_finished.clear(); }

  /// Throws the errors of Outputs. A record of any version may be replaced.
  void declare(Outputs& outputs) const;
  /// Puts the record in place: before the first piece, for a piece without a record cannot be
  /// distinguished from another command's. Throws Error (output).
  void write(Outputs& outputs) const;
  /// Records sizes and digests of the piece's files, by which a damaged or replaced file is
  /// noticed. Call once they are in place. Throws Error (output).
  void finish(int item, const WrittenFiles& files, const nlohmann::json& extra, Outputs& outputs);

private:
  std::filesystem::path m_path;
  std::string m_itemKey;
  nlohmann::json m_document; ///< as read
  nlohmann::json m_request;
  nlohmann::json m_recorded; ///< request in the file; null: not read
  std::map<int, Item> m_finished;
};

} // namespace fenestra
