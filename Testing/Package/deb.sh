#!/usr/bin/env bash
# Tests the Debian package of a build: name, files, dependencies, and the program in it. With `strictly`, also requires
# that lintian accepts it and that packaging is reproducible. Exit status 77: Debian's tools are missing.
# usage: bash Testing/Package/deb.sh BUILD [strictly]
set -euo pipefail
export LC_ALL=C
build=$(cd "$1" && pwd)
for tool in cpack dpkg-deb dpkg-shlibdeps ${2:+lintian}; do
  command -v "$tool" >/dev/null || { echo "SKIPPED: needs $tool"; exit 77; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
  printf '%s\n' "$*"
  exit 1
}
# pack FOLDER: makes the package there.
pack() {
  (cd "$build" && cpack -B "$1") >"$work/log" 2>&1 || fail "packaging failed: $(tail "$work/log")"
}
pack "$work"
version_text=$("$build/bin/fenestra" --version)
version=$(head -n 1 <<<"$version_text" | cut -d ' ' -f 2)
package=$work/fenestra_$version-1_$(dpkg --print-architecture).deb
[ -f "$package" ] || fail "unexpected package name: $(ls "$work"/*.deb)"

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
[ "$files" = "$expected" ] || fail "unexpected files: $(diff <(echo "$expected") <(echo "$files"))"
# Only the beginnings of these names: they end in a version that depends on Debian's release.
needs=$(dpkg-deb -f "$package" Depends)
for library in libc6 libinsighttoolkit libopencolorio libopenexr libtbb libhwy libzip libpng libtiff libfreetype; do
  [[ $needs == *$library* ]] || fail "missing dependency on $library: $needs"
done
[ "$("$usr/bin/fenestra" --version)" = "$version_text" ] || fail "the packaged program differs from the build's"
[ "$(gzip -dc "$usr/share/man/man1/fenestra.1.gz")" = "$("$usr/bin/fenestra" describe man)" ] ||
  fail "the manual page differs from 'fenestra describe man'"
[ $# -lt 2 ] && exit
messages=$(lintian --allow-root --fail-on error,warning "$package" 2>&1) || fail "$messages"
[ -z "$messages" ] || fail "$messages"
pack "$work/again"
cmp "$package" "$work/again/${package##*/}" || fail "packaging is not reproducible"
