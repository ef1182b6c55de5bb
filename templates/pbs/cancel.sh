#!/bin/sh
# cancel.sh NAME: ends the jobs of this name, waiting or running.
server=$(cat "$(dirname "$0")/server" 2>/dev/null)  # as submit.sh leaves it; a later shell may know another
unset PBS_SERVER PBS_DEFAULT
[ -z "$server" ] || export PBS_SERVER="$server" PBS_DEFAULT="$server"
jobs=$(qselect -N "$1" -s QHWTBRSU) || exit 1
set -f  # 12[].server is no pattern
failed=0
for job in $jobs; do
  qdel "$job" && continue
  left=$(qselect -N "$1" -s QHWTBRSU) || failed=1  # it may have ended meanwhile
  for other in $left; do
    [ "$other" != "$job" ] || failed=1
  done
done
exit "$failed"
