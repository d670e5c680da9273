#pragma once
// Command lines of the program under test, and the folders in which they run.

#include "Tracer.h"

#include <map>

namespace fenestra::faults {

struct Request {
  std::string name;
  std::vector<std::string> arguments; ///< arguments, without the executable
  /// Arguments of the runs that wrote the files already there.
  std::vector<std::vector<std::string>> before;
  std::vector<std::vector<std::string>> groups; ///< files that must stem from one request
  std::string stats;    ///< name of the JSON file written after the groups; may be empty
  std::string manifest; ///< name of the JSON file that may precede some groups; may be empty
  /// Name of a film that is kept meanwhile, and may stay old in a run that succeeds with a warning;
  /// may be empty.
  std::string checkpoint = {};
  /// Name of a film that a run which is not done may leave, for the next one; may be empty.
  std::string leftCheckpoint = {};
  std::map<std::string, std::string> inputs = {}; ///< files beside knee.mrb, by name
};

/// Requests: a render with all kinds of files, two frames of a turntable, a phantom, a study, a
/// render that goes on from a film, parts that are merged.
const std::vector<Request>& requests();

struct Tools {
  std::filesystem::path executable, preload, data;
};

/// Content by name; folders end with a slash and have no content.
using Files = std::map<std::string, std::string>;

std::string readBytes(const std::filesystem::path& path);

/// Folder for runs, in /dev/shm if writable, with an empty TMPDIR beside.
class Workspace {
public:
  explicit Workspace(const Tools& tools);
  ~Workspace();
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  /// Empties both folders and writes these files.
  void fill(const Files& files) const;
  /// Runs a command in the folders without changing their files first.
  Outcome run(const std::vector<std::string>& arguments, const Fault& fault) const;

  std::filesystem::path folder() const { return m_root / "folder"; }
  std::filesystem::path temporary() const { return m_root / "temporary"; }
  Files files() const { return listFiles(folder()); }
  Files tempFiles() const { return listFiles(temporary()); }

private:
  /// Files of a folder and its subfolders.
  static Files listFiles(const std::filesystem::path& folder);

  const Tools& m_tools;
  std::filesystem::path m_root;
};

/// Request with its files before and after a run without a fault.
struct Baseline {
  const Request* request;
  Files before, after;
  std::vector<std::string> inputs;
  Outcome outcome;
};

/// Throws std::runtime_error where a request fails without a fault.
Baseline recordBaseline(const Request& request, const Tools& tools);

} // namespace fenestra::faults
