#!/bin/bash
#PBS -l select=1:ncpus=@THREADS@
#PBS -j oe
#PBS -V
# tasks: 0-@LAST@

# One task of the array: its seeds, one after another. PBS sends SIGTERM to every process of the job at the walltime, at
# qdel and at a preemption by requeueing; SIGKILL follows after the kill_delay of the queue, 10 s unless set. The task
# saves a checkpoint and leaves with 75. A preempted job is queued again by PBS; otherwise the task ends here, and
# `peclet ingest` puts its seeds back. submit.sh takes the array from the line above.
index=${PBS_ARRAY_INDEX:-0}  # an array of one task is no array for PBS
exec >>@FOLDER@/logs/task-$index.log 2>&1 || exit 1
@PECLET@ task @MANIFEST@ "$index" &
task=$!
trap 'kill -TERM "$task" 2>/dev/null' TERM
while :; do
  wait "$task"
  code=$?
  kill -0 "$task" 2>/dev/null || break  # a signal ends `wait` too
done
exit "$code"
