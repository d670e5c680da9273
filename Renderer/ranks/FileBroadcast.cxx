#include "ranks/FileBroadcast.h"

#include "base/Error.h"

#include <fstream>

namespace fenestra::core {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t blockBytes = 1 << 24;

/// Calls each(bytes of the next block) for a file of `size` bytes.
template <typename Each>
void forEachBlock(std::uint64_t size, Each&& each) {
  std::vector<char> block(std::min<std::uint64_t>(size, blockBytes));
  for (std::uint64_t done = 0; done < size; done += block.size()) {
    block.resize(std::min<std::uint64_t>(size - done, blockBytes));
    each(std::span(block));
  }
}

} // namespace

void broadcastFiles(const std::vector<fs::path>& files, const Ranks& ranks) {
  std::string working = fs::current_path().string(), none;
  ranks.broadcast(working);
  for (const fs::path& file : files) {
    std::string name = fs::absolute(file).lexically_normal().string();
    std::uint64_t size = fs::file_size(file);
    ranks.broadcast(name);
    ranks.broadcast(std::span(&size, 1));
    std::ifstream content(file, std::ios::binary);
    forEachBlock(size, [&](std::span<char> block) {
      if (!content.read(block.data(), static_cast<std::streamsize>(block.size())))
        throw inputError(ErrorCode::unreadableFile, file,
                         "cannot be read completely; check its disk");
      ranks.broadcast(block);
    });
  }
  ranks.broadcast(none);
}

ReceivedFiles::ReceivedFiles(const Ranks& ranks) {
  std::string text;
  ranks.broadcast(text);
  m_working = text;
  for (ranks.broadcast(text); !text.empty(); ranks.broadcast(text)) {
    std::uint64_t size = 0;
    ranks.broadcast(std::span(&size, 1));
    const fs::path path = m_folder.add(fs::path(text).relative_path());
    std::ofstream file(path, std::ios::binary);
    forEachBlock(size, [&](std::span<char> block) {
      ranks.broadcast(block);
      file.write(block.data(), static_cast<std::streamsize>(block.size()));
    });
    if (!file.flush())
      throw outputError(path, "cannot be written; free some space, or set TMPDIR to another disk");
  }
}

fs::path ReceivedFiles::localPath(const fs::path& remotePath) const {
  return m_folder.path() / (m_working / remotePath).lexically_normal().relative_path();
}

OptionValues ReceivedFiles::localizePaths(const OptionValues& options,
                                          std::span<const Option> known) const {
  OptionValues result = options;
  const auto localize = [&](const std::string& name) {
    result.remove(name);
    for (const std::string& value : options.texts(name)) {
      std::error_code failed;
      const fs::path file = localPath(value);
      result.add(name, fs::exists(file, failed) ? file.string() : value);
    }
  };
  localize("INPUT");
  for (const Option& option : known)
    if (option.canNameFile() && !option.isOutputFile() && options.has(option.name))
      localize(option.name);
  return result;
}

} // namespace fenestra::core
