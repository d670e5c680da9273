#pragma once
// Checkpoint file of a render (--checkpoint), from which the same command resumes. The final image
// is bit for bit that of an uninterrupted render. A mismatch of settings, inputs, version or
// instruction set is an error. `merge` reads the shards of an image through the same class.

#include "io/Outputs.h"
#include "io/platform/Locks.h"
#include "program/RenderSteps.h"
#include "scene/CheckpointFile.h"

namespace fenestra::core {

/// True if samples depend on the option; false for stopping criteria, display and output.
bool isSampleOption(const Option& option);

/// What a checkpoint file stores about its render: version, options as given, and options (after
/// merging) that samples depend on, with the resolved smoothing. File names are relative to
/// `folder`.
nlohmann::ordered_json makeProvenance(const OptionValues& given, const RenderJob& job,
                                      const std::filesystem::path& folder);
/// All files from which the scene was built; an archive instead of its members.
std::vector<std::filesystem::path> listInputFiles(const PreparedScene& scene,
                                                  const RenderOptions& options);
/// Name, size and digest of each of these files.
nlohmann::ordered_json digestInputs(const PreparedScene& scene, const RenderOptions& options,
                                    const std::filesystem::path& folder);

/// First difference between two makeProvenance() objects, as "--seed was 1, is 2"; empty: none.
/// Keys that `current` lacks are not compared. `stored` comes from the file `source` and may be
/// damaged. Throws Error (input).
std::string findDifference(const nlohmann::json& stored, const nlohmann::json& current,
                           const std::string& source);

/// "2/3" for the second of three shards.
std::string formatShard(const Shard& shard);

class Checkpoint {
public:
  using Warn = std::function<void(const std::string&)>;

  /// Locks options.checkpoint, which must be set, and reads an existing file. With automatic
  /// smoothing, `job` gets the smoothing of that file, whatever its outputs would choose. It must
  /// outlive this. Throws Error: usage if another process is writing the file or its settings
  /// differ; input if it is damaged; output if it cannot be written.
  Checkpoint(RenderJob& job, const OptionValues& given, Warn warn);

  /// For merge: all shards of one image, in order; they are read and never written. `job` gets
  /// their smoothing.
  Checkpoint(RenderJob& job, const OptionValues& given, std::vector<CheckpointFile> shards);

  /// State to resume; nullopt: none. Throws Error: usage if the inputs or the instruction set
  /// differ, or the file has more samples than requested; input if it is damaged.
  std::optional<RenderResult> load(const PreparedScene& scene, const RenderSettings& settings);

  /// Saves in pauses of the render: first after a second, then so rarely that writing takes 1 % of
  /// the time, but at least every minute.
  void attach(RenderMonitor& monitor);

  /// As save(), but only the first failure is reported, as a warning. The previous file remains.
  void trySave(const RenderResult& result);

  /// Saves if there are new samples. Throws Error (output).
  void save(const RenderResult& result);

private:
  Error mismatchError(const std::string& difference) const;
  /// Automatic smoothing of the job becomes that of `film`; all other settings must be the same.
  void requireSettings(const CheckpointFile& film, RenderJob& job);
  void requireSame(const CheckpointFile& film, const std::string& key) const;
  void checkSampleCounts(const RenderResult& result, const RenderSettings& settings) const;

  const RenderJob& m_job;
  const std::filesystem::path m_path;
  Warn m_warn;
  std::optional<NameLock> m_lock;
  std::vector<CheckpointFile> m_files; ///< read at the start
  bool m_isMerge = false;
  nlohmann::ordered_json m_provenance;
  Outputs m_outputs;
  std::optional<std::uint64_t> m_savedPaths; ///< in the file on disk
  bool m_hasWarned = false;
};

} // namespace fenestra::core
