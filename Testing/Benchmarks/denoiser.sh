#!/usr/bin/env bash
# Builds Release, measures gain, cost and error estimate of the denoiser, and writes
# Testing/Benchmarks/Report/denoiser.csv. Takes about 40 minutes on two cores, half of them for the
# references, which are cached.
# usage: bash Testing/Benchmarks/denoiser.sh [--scenes A,B] [--counts 4,16] [--seeds 1] [...]
# All arguments are passed to DenoiserBenchmark (see its --help); with arguments, no record is written.
# FENESTRA_BUILD selects another build folder.
source "$(dirname "${BASH_SOURCE[0]}")/record.sh"
record denoiser DenoiserBenchmark "Denoiser, per scene" "$@"
