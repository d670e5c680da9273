#!/usr/bin/env bash
# Loads the printed completions in a shell and checks how it completes commands, options and values; or
# checks the manual page with mandoc. Exit status 1 with the errors, 77 if the shell is not installed.
# usage: completions.sh FENESTRA bash|zsh|fish|man
set -euo pipefail
export LC_ALL=C.UTF-8
program=$(realpath "$1")
kind=$2
tool=${kind/#man/mandoc}
command -v "$tool" >/dev/null || { echo "SKIPPED: needs $tool"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$program" describe "$kind" >"described"
mkdir folder
(cd folder && touch scan.nrrd labels.nrrd look.json)

# Line as typed|completion of its last word; empty: no completion.
cases='fenestra --proj|--projection
fenestra --clip su|surface
fenestra --clip=su|surface
fenestra --quality dr|draft
fenestra -s lab|labels.nrrd
fenestra -o loo|look.json
fenestra tur|turntable
fenestra turntable --frames|--frames
fenestra inspect --samp|
fenestra serve --checkp|
fenestra turntable --surf|
fenestra --checkp|--checkpoint
fenestra inspect --js|--json
fenestra serve scan.nrrd --noise-t|--noise-target
fenestra serve scan.nrrd --noise-target de|denoised
fenestra phantom kn|knee
fenestra phantom cube --ed|--edge
fenestra describe zs|zsh
fenestra scan.nrrd --transfer ct-an|ct-anatomy
fenestra --preset brain-t|brain-tumor
fenestra --lights ci|cinema
fenestra --layers den|denoised
fenestra --spac|--spacing
fenestra inspect --spac|--spacing
fenestra --clip-softness au|auto
fenestra --transfer loo|look.json
fenestra --segmentation lab|labels.nrrd
fenestra compare scan.nrrd lab|labels.nrrd
fenestra sc|scan.nrrd
fenestra --volume sc|
fenestra describe sc|'

# complete_SHELL: prints the completions of each line of standard input, one per line, followed by "/".
complete_bash() {
  (
    set +e # as in an interactive shell
    cd folder
    source ../described
    complete -p fenestra | grep -qx 'complete -F _fenestra fenestra' || echo "not registered"
    while IFS= read -r line; do
      COMP_WORDS=()
      for word in $line; do # as readline does: "=" separates words
        if [[ $word == --*=* ]]; then COMP_WORDS+=("${word%%=*}" = "${word#*=}"); else COMP_WORDS+=("$word"); fi
      done
      [[ $line != *' ' ]] || COMP_WORDS+=("")
      COMP_CWORD=$((${#COMP_WORDS[@]} - 1)) COMPREPLY=()
      _fenestra
      ((${#COMPREPLY[@]} == 0)) || printf '%s\n' "${COMPREPLY[@]}"
      echo /
    done
  )
}
complete_fish() {
  HOME=$work fish --no-config -c 'cd folder
    source ../described
    while read -l line
        complete -C $line | cut -f 1 | string replace -r "^--[a-z-]+=" ""
        echo /
    end'
}
# Uses an interactive zsh in a pseudoterminal, since completion needs its line editor.
complete_zsh() {
  cat >complete.zsh <<'Z'
zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell 'PROMPT= PS2= RPROMPT=; stty -echo; unsetopt beep zle_bracketed_paste 2>/dev/null; cd folder'
zpty -w shell 'autoload -Uz compinit && compinit -D -u'
zpty -w shell 'autoload -Uz +X _fenestra; source ../described 2>/dev/null; compdef _fenestra fenestra'
zpty -w shell 'show() { print -r -- "<<$BUFFER>>"; BUFFER=; zle -I }; zle -N show; bindkey "^T" show'
zpty -w shell 'setopt no_list_ambiguous no_auto_menu; print READY'
zpty -r shell text '*READY*READY*'
while IFS= read -r line; do
  zpty -n -w shell "$line"$'\t\x14'
  zpty -r shell text '*<<*>>*'
  text=${${text##*<<}%%>>*}
  [[ $text == "$line" ]] || print -r -- ${${${${text% }##* }%=}#--*=}
  print /
done
zpty -d shell
Z
  timeout 600 zsh -f complete.zsh
}

# The printed script or page must contain every option of every command's help.
for command in render inspect turntable serve compare phantom describe; do
  "$program" "$command" --help | sed -nE 's/^  (-[a-z], |    )--([a-z-]*).*/\2/p'
done | sort -u >options
[ "$(wc -l <options)" -gt 50 ]
while read -r option; do
  case $kind in
    bash) form=" --$option[ ']|'--$option[ ']" ;;
    zsh) form="--$option(=|\[)" ;;
    fish) form=" -l $option " ;;
    man) form="^.It (Fl [a-z] , )?Fl Fl $option( |\$)" ;;
  esac
  grep -qE -- "$form" described || echo "--$option is missing"
done <options >missing
if [ "$kind" = man ]; then
  mandoc -Tlint described >>missing || true
  mandoc -Tutf8 described >page || true
  [ "$(wc -l <page)" -gt 200 ] || echo "the page is too short" >>missing
else
  "$kind" -n described >>missing 2>&1 || echo "$kind cannot parse the script" >>missing
  cut -d '|' -f 1 <<<"$cases" | "complete_$kind" >actual
  cut -d '|' -f 2 <<<"$cases" | sed 's/$/\n\//' | sed '/^$/d' >expected
  diff --label expected --label actual -U 99 expected actual >>missing || true
fi
cat missing
[ ! -s missing ]
