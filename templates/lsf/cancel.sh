#!/bin/sh
# cancel.sh NAME: ends the jobs of this name, waiting or running.
said=$(bkill -J "$1" 0 2>&1)
code=$?
[ -z "$said" ] || printf '%s\n' "$said" >&2
# bkill fails if there is no such job, or if some task has ended meanwhile; other words are a failure.
[ "$code" -ne 0 ] || exit 0
printf '%s\n' "$said" | awk -v code="$code" '
  NF == 0 || /Please wait|still trying/ { next }
  /is being terminated|has already finished|is not found|^No (unfinished |matching )?job found/ { known = 1; next }
  { strange = 1 }
  END { exit (strange || !known) ? code : 0 }'
