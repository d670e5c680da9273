#!/usr/bin/env bash
# The record of what README and pages cite of this project: Testing/Report/evidence.csv. Each entry carries a hash of the
# sources that it vouches for, without comments, white space, includes and the contents of string literals. The list of
# error codes is left out: no result depends on it.
# usage: bash Testing/evidence.sh check               lists the entries; exit status 1 if sources have changed since
#        bash Testing/evidence.sh hash NAME [COMMIT]  prints the hash of an entry's sources
#        bash Testing/evidence.sh store FOLDER        stores the results of Testing/Report/measure.sh, writes the pages
#        bash Testing/evidence.sh pages               writes the generated parts of README.md and Report/README.md
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../Resources/setup.sh"
report=$top/Testing/Report
record=$report/evidence.csv

# list_sources NAME: prints the folders and files of an entry, as globs.
list_sources() {
  local transport='Renderer/formulas Renderer/base Renderer/model/volume Renderer/model/medium Renderer/model/camera
Renderer/model/lights Renderer/image Renderer/clip Renderer/integrator'
  local matrix='Testing/Oracle Testing/Statistical/Comparison.* Testing/Statistical/Matrix*.* Testing/Statistical/Significance.*'
  local benchmark='Testing/Benchmarks/References.cxx Testing/Benchmarks/Scenes.cxx'
  case $1 in
    matrix) echo "$transport $matrix" ;;
    mutations) echo "$transport $matrix Renderer/model/masks Renderer/model/filtering/SmoothingRequest.h \
Testing/Statistical/MutationTests.cxx Testing/Statistical/ErrorRatio.* Testing/Statistical/Mutations/mutations.json" ;;
    denoiser) echo "$transport Renderer/denoise $benchmark Testing/Benchmarks/DenoiserBenchmark.cxx \
Testing/Benchmarks/denoiser-scenes.txt" ;;
    efficiency) echo "$transport $benchmark Testing/Benchmarks/Baselines.h Testing/Benchmarks/Curve.cxx \
Testing/Benchmarks/Modes.cxx Testing/Benchmarks/scenes.txt" ;;
    figures) echo "$transport Renderer/model/masks Renderer/model/filtering Renderer/metrics Renderer/phantoms Renderer/scene \
Resources/figures/*.sh Resources/phantoms Resources/transfer Resources/lights" ;;
    *) die "$1: no such entry" ;;
  esac
}

# hash_tree ROOT NAME: prints the hash of an entry's sources in a checkout. Moving a file does not change it.
hash_tree() {
  local sources
  sources=$(list_sources "$2") || return
  (
    cd "$1" && shopt -s nullglob
    # shellcheck disable=SC2086
    find $sources -type f '(' -name '*.h' -o -name '*.cxx' -o -name '*.inl' -o -name '*.json' -o -name '*.txt' \
      -o -name '*.sh' ')' \
      ! -name CMakeLists.txt ! -name 'ErrorCode.*' -print0 | xargs -0r perl -MDigest::SHA=sha256_hex -0777 -e "$normalize"
  ) | LC_ALL=C sort | sha256sum | cut -c1-64
}
# Prints the hash of each file. Scripts and tables lose only their lines of comments.
read -r -d '' normalize <<'PERL' || true
for my $file (@ARGV) {
  open(my $in, '<', $file) or die "$file: $!\n";
  $_ = <$in>;
  if ($file =~ /\.(h|cxx|inl)$/) {
    s{^[ \t]*\#[ \t]*include[^\n]*|//[^\n]*|/\*.*?\*/|R"([^(\s]*)\(.*?\)\g{1}"|"(?:[^"\\\n]|\\.)*"|((?<=[0-9a-fA-F])'|'(?:[^'\\\n]|\\.)+')}
     {defined $2 ? $2 : $& =~ /"$/ && $& !~ m{^(//|/\*|\s*\#)} ? '""' : ''}gesm;
    s/\bfenestra::core\b/fenestra/g; # its name since the library has a public namespace
    s/\s+//g;
  } else {
    s/^[ \t]*#[^\n]*\n//gm;
  }
  print sha256_hex($_), "\n";
}
PERL

# hash_commit COMMIT NAME: hash_tree of a commit.
hash_commit() {
  local folder status=0
  folder=$(mktemp -d)
  { git -C "$top" archive "$1" | tar -x -C "$folder" && hash_tree "$folder" "$2"; } 2>/dev/null || status=1
  rm -rf "$folder"
  return $status
}

# Entries: name,date,cpu,threads,commit,sources,"result".
check() {
  local name date cpu threads commit sources result stale=0 changes
  while IFS=, read -r name date cpu threads commit sources result; do
    if [ "$(hash_tree "$top" "$name")" = "$sources" ]; then
      printf 'fresh  %-10s  %s, %.8s\n' "$name" "$date" "$commit"
      continue
    fi
    stale=1
    # shellcheck disable=SC2046
    changes=$(cd "$top" && git diff --shortstat "$commit" -- $(list_sources "$name") 2>/dev/null) ||
      changes=' unknown, since this checkout lacks the commit'
    printf 'STALE  %-10s  %s, %.8s; changes since:%s\n' "$name" "$date" "$commit" "$changes"
  done < <(tail -n +2 "$record")
  return $stale
}

# store FOLDER: an entry vouches for the commit whose programs were measured, whatever the checkout contains now.
store() {
  local file name date cpu threads commit result sources line
  for file in "$1"/*.entry; do
    IFS=, read -r name date cpu threads commit result <"$file" || die "$1: has no entries"
    [[ $commit != trial-* ]] || die "$file: is a trial (FENESTRA_TRIAL)"
    [[ $commit != unknown ]] || die "$file: was measured with a build outside git"
    sources=$(hash_commit "${commit%-dirty}" "$name") || die "$file: cannot read the sources of commit $commit"
    # Uncommitted changes elsewhere, such as those of the record itself, do not matter.
    [[ $commit != *-dirty ]] || [ "$(hash_tree "$top" "$name")" = "$sources" ] ||
      die "$file: was measured with uncommitted changes; commit them, build and measure again"
    line=$name,$date,$cpu,$threads,${commit%-dirty},$sources,$result
    awk -v name="$name," -v line="$line" 'index($0, name) == 1 { $0 = line; found = 1 } { print }
      END { if (!found) print line }' "$record" >"$record.tmp"
    mv "$record.tmp" "$record"
    [ ! -e "$1/$name.csv" ] || cp "$1/$name.csv" "$report"
    say "Stored: $name"
  done
  write_pages
}

# fill FILE NAME: replaces the lines between <!-- NAME: ... --> and <!-- end of NAME --> by standard input.
fill() {
  grep -q "^<!-- $2: " "$1" && grep -qx "<!-- end of $2 -->" "$1" || die "$1: has no part \"$2\""
  awk -v name="$2" '
    $0 == "<!-- end of " name " -->" { inside = 0 }
    NR == FNR { text = text $0 "\n"; next }
    !inside
    index($0, "<!-- " name ": ") == 1 { inside = 1; printf "%s", text }' - "$1" >"$1.tmp"
  mv "$1.tmp" "$1"
}

# get NAME COLUMN: prints a cell of the record.
get() {
  awk -F, -v name="$1" -v column="$2" '$1 == name { print $column }' "$record"
}
# get_result NAME: prints the last cell, without quotes.
get_result() {
  sed -n "s/^$1,.*,\"\(.*\)\"$/\1/p" "$record"
}

# print_mode MODE TITLE: prints a row of the README's table.
print_mode() {
  awk -F, -v mode="$1" -v title="$2" '$2 == mode { of[$1] = sprintf("%.2g", $5) + 0 }
    END { printf "| %s | %s | %s |\n", title, of["S1"], of["S2"] }' "$report/efficiency.csv"
}

print_efficiency() {
  printf '| efficiency, 1 / (relMSE × CPU seconds) | S1 | S2 |\n|---|---|---|\n'
  print_mode product '**Fenestra**'
  print_mode scalar 'plain scalar tracker: delta tracking, grid of majorants, independent samples'
  awk -F, 'NR > 1 { printf "| %s | %s | %s |\n", $1, $2, $3 }' "$report/peers.csv"
  printf '\nThe same scenes (S1: fog; S2: thin shells and balls), lights and cameras, 256 × 256 pixels, two threads. '\
'Fenestra: %s, %s. Others: once, in 2026, on another dual-core machine; compare only the order of magnitude '\
'([details](Testing/Report/README.md#efficiency)).\n' "$(get efficiency 2)" "$(get efficiency 3)" | fold -s -w 120 |
    sed 's/ *$//'
}

print_entries() {
  printf '| entry | result | date | commit | machine |\n|---|---|---|---|---|\n'
  local name date cpu threads commit sources result
  while IFS=, read -r name date cpu threads commit sources result; do
    printf '| %s | %s | %s | %.8s | %s, %s threads |\n' "$name" "${result//\"/}" "$date" "$commit" "$cpu" "$threads"
  done < <(tail -n +2 "$record")
}

print_curves() {
  awk -F, '
    NR > 1 {
      if (!($1 in reference)) scenes[++count] = $1
      reference[$1] = $3
      cell[$1, $2] = $5 == "" ? "no measurable error" : sprintf("%.3g", $5) ($6 == 0.001 ? "" : sprintf(" at %.1e", $6))
      cell[$1, $2] = cell[$1, $2] sprintf("; %+.2f ± %.2f %%", $8, $9)
    }
    END {
      split("product scalar global marching", modes, " ")
      printf "| scene | reference |"
      for (m = 1; m in modes; ++m) printf " %s |", modes[m]
      printf "\n|---|---|---|---|---|---|\n"
      for (s = 1; s <= count; ++s) {
        printf "| %s | %s |", scenes[s], reference[scenes[s]]
        for (m = 1; m in modes; ++m) printf " %s |", cell[scenes[s], modes[m]]
        print ""
      }
    }' "$report/efficiency.csv"
}

print_accuracy() {
  local matrix mutations denoiser
  matrix=$(get_result matrix) mutations=$(get_result mutations) denoiser=$(get_result denoiser)
  printf 'Raw images are unbiased: no step size, no clamping, no tuned epsilon; they agree with those of an independent '\
'renderer in %s of view, clip, light and medium, a test that finds %s inserted errors. Display images are denoised, with '\
'an error estimate that was %s ([record](Testing/Report/README.md)).\n' \
    "${matrix%%,*}" "${mutations##*: }" "${denoiser#the estimate was }" | sed 's/ found inserted/ inserted/'
}

write_pages() {
  print_efficiency | fill "$top/README.md" efficiency
  print_accuracy | fold -s -w 120 | sed 's/ *$//' | fill "$top/README.md" accuracy
  print_entries | fill "$report/README.md" entries
  print_curves | fill "$report/README.md" curves
}

case ${1:-} in
  check) check ;;
  hash) if [ $# -gt 2 ]; then hash_commit "$3" "$2"; else hash_tree "$top" "${2:-}"; fi ;;
  store) store "${2:?folder of measure.sh}" ;;
  pages) write_pages ;;
  *) die "usage: evidence.sh check | hash NAME [COMMIT] | store FOLDER | pages" ;;
esac
