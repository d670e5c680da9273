#pragma once
// `fenestra render` in all processes of one mpirun.

namespace fenestra::core {

/// Runs this process's part of the command: all of it in rank 0, shards of its image in the others.
/// A process without others runs any command. Returns the exit status.
int dispatchRank(int argc, char** argv);

} // namespace fenestra::core
