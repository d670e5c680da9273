#pragma once
// Film of a render that is under way, on disk (--checkpoint): the same command goes on from it.

#include "base/Stopwatch.h"
#include "io/Locks.h"
#include "io/Outputs.h"
#include "program/RenderSteps.h"
#include "scene/CheckpointFile.h"

namespace fenestra {

/// True if a sample depends on the flag; false if only when to stop, how a picture is shown, and
/// where.
bool isSampleOption(const Option& option);

/// Facts that a film is made with: the version, the flags as given and those that shape its
/// samples, by name, and the content of all files read; names are relative to `folder`.
nlohmann::ordered_json makeProvenance(const OptionValues& given, const OptionValues& options,
                                      const std::filesystem::path& folder);
/// All files that the scene was made from; an archive, not its members.
std::vector<std::filesystem::path> listInputFiles(const PreparedScene& scene,
                                                  const RenderOptions& options);
/// Name, size and digest of every file that the scene was made from.
nlohmann::ordered_json digestInputs(const PreparedScene& scene, const RenderOptions& options,
                                    const std::filesystem::path& folder);

/// First difference between what two films, or a film and a command, are made with, as "--seed was
/// 1, is 2"; empty: none. `there` may be damaged, and is the film that `source` names; a key that
/// `here` lacks is not compared. Throws Error (input).
std::string findDifference(const nlohmann::json& stored, const nlohmann::json& current,
                           const std::string& source);

/// "2/3" for the second of three parts.
std::string formatShard(const Shard& shard);

class Checkpoint {
public:
  using Warn = std::function<void(const std::string&)>;

  /// Locks options.checkpoint, which must be set, and reads what is there. The request must outlive
  /// this. Throws Error: usage where another process writes that film, or it belongs to other
  /// settings; input where it is damaged; output where none can be written.
  Checkpoint(const RenderJob& job, const OptionValues& given, Warn warn);

  /// The parts of one picture, in their order (readShards), which are read and never written.
  Checkpoint(const RenderJob& job, const OptionValues& given, std::vector<CheckpointFile> shards);

  /// Result to go on from; nothing: from the beginning. Throws Error: usage where the film belongs
  /// to other inputs, another instruction set, or more samples than the settings allow; input.
  std::optional<RenderResult> load(const PreparedScene& scene, const RenderSettings& settings);

  /// Lets a render be kept: first after a second, then so often that writing takes 1 % of the time,
  /// or each minute if it takes more.
  void attach(RenderMonitor& monitor);

  /// Writes the film, if there is more than in the one on disk. A failure is one warning, however
  /// often: the earlier film stays.
  void trySave(const RenderResult& result);

  /// Writes the film, which is the command's result. Throws Error (output).
  void save(const RenderResult& result);

private:
  Error mismatchError(const std::string& difference) const;
  void requireSame(const CheckpointFile& film, const std::string& key) const;
  void checkSampleCounts(const RenderResult& result, const RenderSettings& settings) const;

  const RenderJob& m_job;
  const std::filesystem::path m_path;
  Warn m_warn;
  std::optional<NameLock> m_lock;
  std::vector<CheckpointFile> m_files; ///< as they were at the start
  bool m_isMerge = false;
  nlohmann::ordered_json m_provenance;
  Outputs m_outputs;
  std::optional<std::uint64_t> m_savedPaths; ///< in the film on disk
  Stopwatch m_watch;
  double m_dueTime = 1.0; ///< s by m_watch
  bool m_hasWarned = false;
};

} // namespace fenestra
