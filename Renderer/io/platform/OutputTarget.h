#pragma once
// What a result's name stands for: a file, or a stream. For io/Outputs.

#include <filesystem>
#include <optional>
#include <string>

namespace fenestra::core {

/// File that writing to `path` would change; links are followed, dangling ones as well. The folder
/// is canonical, so that each file has one name. Throws Error (output).
std::filesystem::path resolveTarget(const std::filesystem::path& path);

/// Throws Error (output) unless a file at `target` can be created or replaced; `path` is its name
/// in messages.
void requireReplaceable(const std::filesystem::path& path, const std::filesystem::path& target);

/// Syncs the names in a folder. Throws Error (output).
void syncFolder(const std::filesystem::path& folder);

inline constexpr int namedPipe = -1; ///< stream that is opened when its content is sent

/// Descriptor of a result that is not a file: /dev/stdout, /dev/stderr, /dev/fd/N, /proc/self/fd/N,
/// or `namedPipe`; nullopt: other paths. Throws Error (output) if the descriptor is not open for
/// writing.
std::optional<int> findStream(const std::filesystem::path& path);

/// Writes `content` to the stream that findStream found. Throws Error (output), also if no process
/// reads the pipe.
void sendContent(int stream, const std::string& content, const std::filesystem::path& path);

} // namespace fenestra::core
