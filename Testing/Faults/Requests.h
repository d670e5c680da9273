#pragma once
// What the program under test is asked for, and where it runs.

#include "Tracer.h"

#include <map>

namespace fenestra::faults {

struct Request {
  std::string name;
  std::vector<std::string> words;               ///< of the command line, without the executable
  std::vector<std::string> before;              ///< of the one that wrote what is there already
  std::vector<std::vector<std::string>> groups; ///< files that are all of one request
  std::string stats;                            ///< JSON that follows the groups; may be empty
  std::string record;                           ///< JSON that may be ahead of some; may be empty
};

/// A render with all kinds of files, two frames of a turntable, a phantom.
const std::vector<Request>& requests();

struct Tools {
  std::filesystem::path executable, preload, data;
};

/// Content by name; folders end with a slash and have none.
using Files = std::map<std::string, std::string>;

std::string bytesOf(const std::filesystem::path& path);

/// A folder for runs, in memory where there is some, and an empty TMPDIR beside it.
class Place {
public:
  explicit Place(const Tools& tools);
  ~Place();
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  /// Both folders anew, with these files.
  void fill(const Files& files) const;
  /// Runs in them as they are.
  Outcome run(const std::vector<std::string>& words, const Fault& fault) const;

  std::filesystem::path folder() const { return m_root / "folder"; }
  std::filesystem::path temporary() const { return m_root / "temporary"; }
  Files files() const { return filesIn(folder()); }
  Files temporaries() const { return filesIn(temporary()); }

private:
  /// Of a folder and of those in it.
  static Files filesIn(const std::filesystem::path& folder);

  const Tools& m_tools;
  std::filesystem::path m_root;
};

/// A request, and its files as they are before and after a run without a fault.
struct Subject {
  const Request* request;
  Files before, after;
  std::vector<std::string> inputs;
  Outcome undisturbed;
};

/// Throws std::runtime_error where a request fails without a fault.
Subject learn(const Request& request, const Tools& tools);

} // namespace fenestra::faults
