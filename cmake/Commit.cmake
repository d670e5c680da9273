# Writes FILE from TEMPLATE with @COMMIT@, @COMMIT_DATE@ (2026-11-26) and @COMMIT_TIME@ (as in a mail header) of the
# checkout SOURCE, unless FILE is up to date. Outside git, the commit is "unknown", and the time is the environment
# variable SOURCE_DATE_EPOCH, or now.
# usage: cmake -DSOURCE=FOLDER -DGIT=PROGRAM -DTEMPLATE=FILE.in -DFILE=FILE -P Commit.cmake
set(COMMIT unknown)
if(GIT AND EXISTS "${SOURCE}/.git") # not the repository of a parent folder
  execute_process(COMMAND "${GIT}" -C "${SOURCE}" describe --always --dirty --exclude=* --abbrev=40
    OUTPUT_VARIABLE found OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  execute_process(COMMAND "${GIT}" -C "${SOURCE}" show --no-patch --format=%ct HEAD
    OUTPUT_VARIABLE seconds OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed)
    set(COMMIT ${found})
    if(NOT DEFINED ENV{SOURCE_DATE_EPOCH})
      set(ENV{SOURCE_DATE_EPOCH} ${seconds})
    endif()
  endif()
endif()
string(TIMESTAMP COMMIT_DATE "%Y-%m-%d" UTC)
string(TIMESTAMP COMMIT_TIME "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file("${TEMPLATE}" "${FILE}" @ONLY)
