#!/bin/sh
# Starts the program with the archive's loader and libraries, from any folder and through symbolic links.
self=$(readlink -f -- "$0") || exit 2
root=${self%/*/*}
unset LD_PRELOAD LD_LIBRARY_PATH LD_AUDIT ITK_AUTOLOAD_PATH # libraries of this system are incompatible
exec "$root/lib/ld.so" --inhibit-cache "$root/libexec/fenestra" "$@"
