#!/bin/sh
# query.sh NAME: what has become of the tasks of the jobs of this name, one line each: JOB INDEX waiting|running|ended.
# Tasks that are not listed have ended or were never there. Any other exit code than 0 means that nobody knows.
# Variables of the user would leave jobs out.
unset SLURM_CLUSTERS $(env | sed -n 's/^\(SQUEUE_[A-Z0-9_]*\)=.*/\1/p')
clusters=$(cat "$(dirname "$0")/clusters" 2>/dev/null)  # as submit.sh leaves them
answer=$(squeue ${clusters:+--clusters="$clusters"} --noheader --me --array --states=all --name="$1" --format='%F %K %T') || exit 1
[ -z "$answer" ] || printf '%s\n' "$answer" | awk '
  NF == 0 || $1 == "CLUSTER:" { next }  # a heading, which some versions print all the same
  $3 ~ /^(BOOT_FAIL|CANCELLED|COMPLETED|DEADLINE|FAILED|NODE_FAIL|OUT_OF_MEMORY|PREEMPTED|REVOKED|TIMEOUT)$/ {
    if ($2 != "N/A") print $1, $2, "ended"  # a whole array that has ended is no task
    next }
  $3 ~ /^(PENDING|REQUEUED|REQUEUE_FED|REQUEUE_HOLD|SPECIAL_EXIT)$/ { print $1, $2, "waiting"; next }
  { print $1, $2, "running" }'
