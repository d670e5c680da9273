#!/usr/bin/env bash
# Builds Release, measures what the filter gains and costs and whether its told error is true, and
# writes Testing/Benchmarks/Report/filter.md. About 40 minutes of two cores, half of them for references,
# which are kept. usage: bash Testing/Benchmarks/filter.sh [--scenes A,B] [--counts 4,16] [--seeds 1] [...]
# All arguments are FilterBenchmark's own, which --help lists; with any of them the page is not written.
# FENESTRA_BUILD names another build folder.
source "$(dirname "${BASH_SOURCE[0]}")/page.sh"
page filter FilterBenchmark "The filter, scene by scene" "What the filter gains" \
  the-filter-filterbenchmark "$@"
