#!/bin/bash
#BSUB -J "@NAME@[1-@TASKS@]"
#BSUB -n @THREADS@
#BSUB -R "span[hosts=1]"
#BSUB -o lsf-%J-%I.txt
#BSUB -r
#BSUB -wa USR1
#BSUB -wt 2

# One task of the array: its seeds, one after another. LSF warns every process of the job by SIGUSR1 two minutes before
# the run limit (-wa, -wt), by SIGUSR2 at it, and by SIGINT and SIGTERM before it kills. Each makes the task save a
# checkpoint and leave with 75; `peclet ingest` puts its seeds back. After the failure of a host LSF runs it again (-r).
# -Q 75 would run it again after 75, but perhaps also after bkill, of which IBM's pages say nothing.
index=$((LSB_JOBINDEX - 1))  # LSF counts from 1
exec >>@FOLDER@/logs/task-$index.log 2>&1 || exit 1
trap '' INT USR2  # the task inherits this, and peclet asks it by SIGTERM
@PECLET@ task @MANIFEST@ "$index" &
task=$!
trap 'kill -TERM "$task" 2>/dev/null' INT TERM USR1 USR2
while :; do
  wait "$task"
  code=$?
  kill -0 "$task" 2>/dev/null || break  # a signal ends `wait` too
done
exit "$code"
