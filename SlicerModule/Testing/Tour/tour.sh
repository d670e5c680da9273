#!/usr/bin/env bash
# Runs the tutorial in a real Slicer on a virtual screen. usage: tour.sh SLICER MODULES FENESTRA REPORT
# FENESTRA_TOUR_QUALITY: 0 draft, 1 good, 2 final. FENESTRA_TOUR_PATIENCE: factor on all waiting times, for a busy
# machine or a higher quality. Leaves screenshots and tour.json in REPORT. Fails if a step fails, or if Slicer logs a
# warning or error that names Fenestra.
set -euo pipefail
slicer=$1 modules=$2 fenestra=$3 report=$4
rm -rf "$report"
mkdir -p "$report/home/.config"
"$fenestra" phantom knee --output "$report/knee" >/dev/null
commands=$(dirname "$modules")/cli-modules
slicer_libraries=$(echo "$(dirname "$slicer")"/../lib/Slicer-*)
export LD_LIBRARY_PATH="$modules:$slicer_libraries/qt-loadable-modules:$slicer_libraries/cli-modules${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
export HOME="$report/home" FENESTRA_TOUR="$report"
export SLICER_BACKGROUND_THREAD_PRIORITY=0 # Slicer applies it to its whole process, so a busy machine would starve it
settings="$HOME/.config/NA-MIC"
mkdir -p "$settings"
printf '[MainWindow]\nDontShowDisclaimerMessage=1024\nDontConfirmExit=1024\nDontConfirmSceneSave=1024\n' >"$settings/Slicer.ini"
status=0
timeout $((800 * ${FENESTRA_TOUR_PATIENCE:-1})) xvfb-run -a -s "-screen 0 1600x1000x24" "$slicer" --no-splash \
  --additional-module-paths "$modules" "$commands" --verbose-module-discovery \
  >"$report/slicer.log" 2>&1 || status=$?
cat "$report/tour.json" || true
if [ "$status" -ne 0 ]; then
  tail -n 30 "$report/slicer.log"
  exit "$status"
fi
if grep -iE '(warning|error).*fenestra|fenestra.*(warning|error)' "$report/slicer.log" |
  grep -v 'completed without errors$'; then
  echo "Slicer's log contains the warnings or errors above" >&2
  exit 1
fi
