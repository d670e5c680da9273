#!/usr/bin/env bash
# Tests of the Python package in a build folder. usage: bash run.sh INTERPRETER BUILD
set -euo pipefail
skip() {
  echo "skipped: $1"
  exit 77
}
tests=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$2"
compgen -G "python/fenestra/_fenestra.*.so" >/dev/null || skip "the Python module was not built; install pybind11-dev"
"$1" -c 'import numpy, pytest' 2>/dev/null || skip "numpy or pytest is missing for $1"
export PYTHONPATH=$PWD/python FENESTRA_BUILD=$PWD PYTHONDONTWRITEBYTECODE=1
exec "$1" -m pytest -q -rs -p no:cacheprovider "$tests"
