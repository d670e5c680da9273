#pragma once
// Command lines of the program under test, and the folders that they run in.

#include "Tracer.h"

#include <map>

namespace fenestra::core::faults {

struct Request {
  std::string name;
  std::vector<std::string> arguments; ///< arguments, without the executable
  /// Commands that create the existing files, before the run with a fault.
  std::vector<std::vector<std::string>> before;
  std::vector<std::vector<std::string>>
      groups;           ///< sets of files; all files of a set must belong to one request
  std::string stats;    ///< JSON file that is written after the groups; may be empty
  std::string manifest; ///< JSON file that may be written before some groups; may be empty
  /// Checkpoint file, which may stay old if the run succeeds with a warning; may be empty.
  std::string checkpoint = {};
  /// Checkpoint file that may remain if the run does not succeed; may be empty.
  std::string leftCheckpoint = {};
  std::map<std::string, std::string> inputs = {}; ///< further input files by name
};

/// A render with all kinds of outputs, a turntable, a phantom, a batch, a render that resumes from
/// a checkpoint, and a merge of shards.
const std::vector<Request>& requests();

struct Tools {
  std::filesystem::path executable, preload, data;
};

/// File contents by name. The names of folders end with a slash.
using Files = std::map<std::string, std::string>;

std::string readBytes(const std::filesystem::path& path);

/// Temporary folder for runs, in /dev/shm if possible, with a separate TMPDIR.
class Workspace {
public:
  explicit Workspace(const Tools& tools);
  ~Workspace();
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  /// Empties the folder and TMPDIR, then writes these files.
  void fill(const Files& files) const;
  /// Runs a command with the files that are currently in the folders.
  Outcome run(const std::vector<std::string>& arguments, const Fault& fault) const;

  std::filesystem::path folder() const { return m_root / "folder"; }
  std::filesystem::path temporary() const { return m_root / "temporary"; }
  Files files() const { return listFiles(folder()); }
  Files tempFiles() const { return listFiles(temporary()); }

private:
  /// Files in a folder and its subfolders.
  static Files listFiles(const std::filesystem::path& folder);

  const Tools& m_tools;
  std::filesystem::path m_root;
};

/// Request with its files before and after a run without faults.
struct Baseline {
  const Request* request;
  Files before, after;
  std::vector<std::string> inputs;
  Outcome outcome;
};

/// Runs a request without faults. Throws std::runtime_error if it fails.
Baseline recordBaseline(const Request& request, const Tools& tools);

} // namespace fenestra::core::faults
