#!/usr/bin/env bash
# Makes the images of SlicerModule/Tutorial.md from a tour's screenshots. Needs ImageMagick.
# usage: FENESTRA_TOUR_QUALITY=1 ctest -R qSlicerFenestraTour, then: pictures.sh REPORT
set -euo pipefail
report=$1
pictures=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)/Resources/pictures
for step in 1-start 2-loaded 3-opened 4-focus 5-turned 6-rendering 7-result 8-closed 9-reloaded \
  10-repeated 11-command 12-hole 13-surroundings 14-view 15-anatomy 16-measures 18-turntable \
  19-view-opened 22-view-photorealistic; do
  convert "$report/$step.png" -resize 1200x -quality 82 "$pictures/slicer-${step#*-}.jpg"
done
