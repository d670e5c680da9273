#!/bin/sh
# Starts the Fenestra of this archive with its own loader and libraries: from any folder, through links.
self=$(readlink -f -- "$0") || exit 2
root=${self%/*/*}
unset LD_PRELOAD LD_LIBRARY_PATH LD_AUDIT ITK_AUTOLOAD_PATH # libraries of this system do not fit
exec "$root/lib/ld.so" --inhibit-cache "$root/libexec/fenestra" "$@"
