#pragma once
// Content of ITK's transform files, read by a child process: ITK and HDF5 take memory for whatever
// sizes a file declares, and abort or go astray on damage.

#include <filesystem>
#include <string>

namespace fenestra {

/// Answer of the child about a .tfm, .txt, .mat, .h5 or .hdf5 file: for each transform its type's
/// name, parameters and fixed parameters (AnswerReader). Empty: the file is damaged or exceeds the
/// child's limits. Throws Error (output) where no process can be started.
std::string transformAnswer(const std::filesystem::path& path);

} // namespace fenestra
