#!/bin/sh
# query.sh NAME: what has become of the tasks of the jobs of this name, one line each: JOB INDEX waiting|running|ended.
# Tasks that are not listed have ended or were never there. Any other exit code than 0 means that nobody knows.
said=$(bjobs -a -noheader -o 'jobid jobindex stat' -J "$1" 2>&1)
code=$?
# A name without jobs has another exit code than 0, or not, as the site likes: the words count.
printf '%s\n' "$said" | awk -v name="$1" -v code="$code" '
  NF == 0 || /Please wait|still trying/ { next }
  $0 ~ /^No (unfinished |matching )?job found/ || index($0, "Job <" name "> is not found") == 1 { none = 1; next }
  NF != 3 || $1 !~ /^[0-9]+(\[[0-9]+\])?$/ || $2 !~ /^[1-9][0-9]*$/ || $3 !~ /^[A-Z_]+$/ {
    print | "cat >&2"; strange = 1; next }
  { sub(/\[.*/, "", $1)
    state = "running"
    if ($3 ~ /^(PEND|PSUSP|WAIT|PROV|FWD_PEND)$/) state = "waiting"
    if ($3 ~ /^(DONE|EXIT|POST_DONE|POST_ERR|ZOMBI)$/) state = "ended"  # ZOMBI: killed, or run again elsewhere
    tasks = tasks $1 " " $2 - 1 " " state "\n" }
  END {
    if (strange || !none && (code != 0 || tasks == "")) exit 1
    printf "%s", tasks }'
