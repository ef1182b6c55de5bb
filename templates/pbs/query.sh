#!/bin/sh
# query.sh NAME: what has become of the tasks of the jobs of this name, one line each: JOB INDEX waiting|running|ended.
# Tasks that are not listed have ended or were never there. Any other exit code than 0 means that nobody knows.
# One answer says which tasks there are, so that none is missed between two; the other one only tells who runs. qselect
# would leave suspended jobs out of a list of states that begins with R.
server=$(cat "$(dirname "$0")/server" 2>/dev/null)  # as submit.sh leaves it; a later shell may know another
unset PBS_SERVER PBS_DEFAULT
[ -z "$server" ] || export PBS_SERVER="$server" PBS_DEFAULT="$server"
all=$(qselect -T -N "$1" -s QHWTBRSUE) || exit 1
[ -n "$all" ] || exit 0
running=$(qselect -T -N "$1" -s ERSU) || exit 1
printf '%s\n' "$running" --- "$all" | awk '
  $0 == "---" { complete = 1; next }
  !complete { runs[$0]; next }
  /^[0-9]+\[\]/ { next }  # the array itself
  !/^[0-9]+(\[[0-9]+\])?(\.[^ ]*)?$/ { print | "cat >&2"; strange = 1; next }
  { parts = split($0, part, "[][]")
    task = parts == 1 ? $0 " 0" : part[1] "[]" part[3] " " part[2]
    print task, ($0 in runs) ? "running" : "waiting" }
  END { exit strange }'
