#!/usr/bin/env bash
# The Debian package of a build: its name, what it holds and needs, the program in it. With `strictly`, lintian's
# verdict, too, and that it has the same bytes when it is made again. Exit status 77: Debian's tools are missing.
# usage: bash Testing/Package/deb.sh BUILD [strictly]
set -euo pipefail
export LC_ALL=C
build=$(cd "$1" && pwd)
for tool in cpack dpkg-deb dpkg-shlibdeps ${2:+lintian}; do
  command -v "$tool" >/dev/null || { echo "SKIPPED: there is no $tool here"; exit 77; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
  printf '%s\n' "$*"
  exit 1
}
# pack FOLDER: makes the package there.
pack() {
  (cd "$build" && cpack -B "$1") >"$work/log" 2>&1 || fail "no package: $(tail "$work/log")"
}
pack "$work"
said=$("$build/bin/fenestra" --version)
version=$(head -n 1 <<<"$said" | cut -d ' ' -f 2)
package=$work/fenestra_$version-1_$(dpkg --print-architecture).deb
[ -f "$package" ] || fail "another name: $(ls "$work"/*.deb)"

dpkg-deb -x "$package" "$work/root"
usr=$work/root/usr
files=$(cd "$usr" && find . -type f | sort)
expected='./bin/fenestra
./share/bash-completion/completions/fenestra
./share/doc/fenestra/CITATION.cff
./share/doc/fenestra/README.md
./share/doc/fenestra/changelog.Debian.gz
./share/doc/fenestra/changelog.gz
./share/doc/fenestra/copyright
./share/fish/vendor_completions.d/fenestra.fish
./share/lintian/overrides/fenestra
./share/man/man1/fenestra.1.gz
./share/zsh/vendor-completions/_fenestra'
[ "$files" = "$expected" ] || fail "other files: $(diff <(echo "$expected") <(echo "$files"))"
# Libraries whose names end in their version, by the release of Debian.
needs=$(dpkg-deb -f "$package" Depends)
for library in libc6 libinsighttoolkit libopencolorio libopenexr libtbb libhwy libzip libpng libtiff; do
  [[ $needs == *$library* ]] || fail "it does not depend on $library: $needs"
done
[ "$("$usr/bin/fenestra" --version)" = "$said" ] || fail "the packed program is another"
[ "$(gzip -dc "$usr/share/man/man1/fenestra.1.gz")" = "$("$usr/bin/fenestra" describe man)" ] ||
  fail "the manual page is another"
[ $# -lt 2 ] && exit
verdict=$(lintian --allow-root --fail-on error,warning "$package" 2>&1) || fail "$verdict"
[ -z "$verdict" ] || fail "$verdict"
pack "$work/again"
cmp "$package" "$work/again/${package##*/}" || fail "made again, it is another"
