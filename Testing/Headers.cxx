// Empty: CMake requires a source in the target that precompiles the tests' headers.
