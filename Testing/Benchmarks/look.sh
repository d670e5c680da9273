#!/usr/bin/env bash
# Builds Release, measures how pictures look with all defaults (spread of lightness over skin, colour
# difference across a focus's edge), and writes Testing/Benchmarks/Report/look.md. About 3 minutes of two
# cores. usage: bash Testing/Benchmarks/look.sh [--scenes A,B] [...]
# All arguments are LookBenchmark's own, which --help lists; with any of them the page is not written.
# FENESTRA_BUILD names another build folder.
source "$(dirname "${BASH_SOURCE[0]}")/page.sh"
page look LookBenchmark "The look, scene by scene" "How pictures look, in numbers" \
  the-look-lookbenchmark "$@"
