#!/usr/bin/env bash
# Creates the static library: one object, with the public interface as its only names, from the archive of the public
# interface and those that it needs. It is to be linked with the shared libraries that libfenestra.so names.
# usage: bash static.sh libfenestra.so FOLDER PUBLIC.a MODULE.a...
# Writes FOLDER/libfenestra.a, FOLDER/fenestra.pc from FOLDER/fenestra.pc.in, and FOLDER/FenestraStatic.cmake.
set -euo pipefail
shared=$1 folder=$2 public=$3
shift 3
cd "$folder"
"${LD:-ld}" -r --force-group-allocation --whole-archive "$public" --no-whole-archive --start-group "$@" --end-group \
  -o fenestra.o
"${OBJCOPY:-objcopy}" --localize-hidden --strip-debug fenestra.o
rm -f libfenestra.a
"${AR:-ar}" rcs libfenestra.a fenestra.o
rm fenestra.o
needed=$(readelf --dynamic "$shared" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/-l:\1/p' | grep -v -e ld-linux -e 'lib\(c\|m\|stdc++\|gcc_s\)\.so')
sed "s/@NEEDED@/${needed//$'\n'/ }/" fenestra.pc.in >fenestra.pc
sed "s/@NEEDED@/${needed//$'\n'/;}/" FenestraStatic.cmake.in >FenestraStatic.cmake
