# For checks of the renderer's sources, in the folder RENDERER: `sources`, relative to it, and the end of a check.
file(GLOB_RECURSE sources RELATIVE "${RENDERER}" "${RENDERER}/*.h" "${RENDERER}/*.cxx" "${RENDERER}/*.inl")

# Fails if there are errors, or hardly any sources: then RENDERER is wrong.
function(report_errors errors advice)
  list(LENGTH sources count)
  if(errors OR count LESS 100)
    list(JOIN errors "\n" text)
    message("${text}")
    message(FATAL_ERROR "${RENDERER}: ${count} sources; ${advice}")
  endif()
endfunction()
