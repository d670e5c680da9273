#!/usr/bin/env bash
# Tests Testing/evidence.sh in a small repository: which changes make an entry stale, and what can be stored.
# usage: test.sh
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
  echo "FAILED: $*" >&2
  exit 1
}
command -v git >/dev/null && perl -MDigest::SHA -e 1 || {
  echo 'SKIPPED: needs git and perl'
  exit 77
}

# Every entry of the real record has sources.
tail -n +2 "$top/Testing/Report/evidence.csv" | while IFS=, read -r name _; do
  bash "$top/Testing/evidence.sh" hash "$name" >/dev/null || fail "$name: no hash"
done

cd "$work"
mkdir -p Renderer/{formulas,base,model/{volume,medium,camera,lights},image,clip,integrator} Resources Testing/{Oracle,Report}
cp "$top/Resources/setup.sh" Resources
cp "$top/Testing/evidence.sh" Testing
cp "$top"/Testing/Report/{README.md,efficiency.csv,peers.csv} Testing/Report
cp "$top/README.md" .
echo 'name,date,cpu,threads,commit,sources,result' >Testing/Report/evidence.csv
source=Renderer/integrator/Step.cxx
write_source() {
  cat >"$source" <<'CODE'
// A comment, isn't it?
#include "Step.h"
double step(double x) {
  if (x < 1'000.0) /* "quoted" */
    throw Error("x // is too small");
  return 2.0 * x + 'a';
}
CODE
}
write_source
echo 'FORMULA int x;' >Renderer/formulas/Other.inl
for folder in Renderer/{base,model/{volume,medium,camera,lights},image,clip} Testing/Oracle; do
  echo 'int x;' >$folder/Other.cxx
done
git init -q
git config user.email test@example.org
git config user.name Test
git add .
git commit -qm 'Sources'
commit=$(git rev-parse HEAD)

# store_entry COMMIT: stores an entry measured with programs of this commit.
store_entry() {
  mkdir -p results
  printf 'matrix,2026-01-01,A CPU,2,%s,"240 combinations"\n' "$1" >results/matrix.entry
  bash Testing/evidence.sh store results >log.txt 2>&1
}
is_fresh() {
  bash Testing/evidence.sh check >log.txt
}

store_entry "$commit" || fail "an entry is not stored: $(cat log.txt)"
grep -q '240 combinations' Testing/Report/README.md && grep -q '240 combinations' README.md || fail 'pages lack a result'
is_fresh || fail "unchanged sources are stale: $(cat log.txt)"

# change EXPRESSION: changes the source by sed.
change() {
  write_source
  sed -i "$1" "$source"
  ! git diff --quiet -- "$source" || fail "$1 changes nothing"
}
for same in 's/A comment/Another/' 's/too small/too low/' 's/quoted/"/' 's/  return/return/' 's/Step.h/base\/&/'; do
  change "$same"
  is_fresh || fail "$same makes an entry stale"
done
for other in 's/2.0/2.1/' "s/1'000/1'001/" "s/'a'/'b'/" 's/x < 1/x > 1/' '/throw/d' "s/.*quoted.*/&;/"; do
  change "$other"
  ! is_fresh || fail "$other leaves an entry fresh"
  grep -q '^STALE *matrix .*1 file changed' log.txt || fail "check does not name the change: $(cat log.txt)"
  if store_entry "$commit-dirty"; then fail "$other: uncommitted sources are stored"; fi
done
# Results of older programs do not vouch for newer sources.
git commit -qam 'Change'
store_entry "$commit" || fail "an entry of an older commit is not stored: $(cat log.txt)"
! is_fresh || fail 'an entry vouches for sources that are newer than its programs'
if store_entry "trial-$commit"; then fail 'a trial is stored'; fi
if store_entry "${commit//[0-9]/0}"; then fail 'an entry of an unknown commit is stored'; fi
store_entry "$(git rev-parse HEAD)-dirty" || fail "changes elsewhere prevent storing: $(cat log.txt)"
is_fresh || fail 'an entry of the current commit is stale'
echo 'FORMULA int y;' >Renderer/formulas/Other.inl
! is_fresh || fail 'a changed formula leaves an entry fresh'
git checkout -q Renderer/formulas
git mv "$source" Renderer/model/volume/Step.cxx
is_fresh || fail 'a moved source is stale'
echo 'int y;' >Renderer/model/medium/New.cxx
! is_fresh || fail 'a new source leaves an entry fresh'
echo 'Entries are stale if and only if their sources have changed.'
