#pragma once
// `fenestra render` by all processes of one mpirun.

namespace fenestra {

/// Runs this process's part of the command: all of it in rank 0, tiles of its picture in the
/// others; any command, as ever, in a process that is alone. Returns the exit status.
int dispatchRank(int argc, char** argv);

} // namespace fenestra
