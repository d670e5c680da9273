#!/usr/bin/env bash
# Builds Release, measures images rendered with default options (spread of lightness over skin, color
# difference across the focus edge), and writes Testing/Benchmarks/Report/appearance.csv. Takes about 3
# minutes on two cores. usage: bash Testing/Benchmarks/appearance.sh [--scenes A,B] [...]
# All arguments are passed to AppearanceBenchmark (see its --help); with arguments, no record is written.
# FENESTRA_BUILD selects another build folder.
source "$(dirname "${BASH_SOURCE[0]}")/record.sh"
record appearance AppearanceBenchmark "Appearance, per scene" "$@"
