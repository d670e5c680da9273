// Empty: CMake requires a source in a target that precompiles headers.
