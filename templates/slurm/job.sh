#!/bin/bash
#SBATCH --job-name=@NAME@
#SBATCH --array=0-@LAST@
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=@THREADS@
#SBATCH --output=@FOLDER@/logs/task-%a.log
#SBATCH --open-mode=append
#SBATCH --requeue
#SBATCH --signal=B:USR1@120

# One task of the array: its seeds, one after another. Slurm warns by SIGUSR1 two minutes before the time limit, and by
# SIGTERM at a preemption or scancel; either makes the task save a checkpoint and leave with 75.
@PECLET@ task @MANIFEST@ "$SLURM_ARRAY_TASK_ID" &
task=$!
limit=no
trap 'limit=yes; kill -TERM "$task" 2>/dev/null' USR1
trap 'kill -TERM "$task" 2>/dev/null' TERM
while :; do
  wait "$task"
  code=$?
  kill -0 "$task" 2>/dev/null || break  # a signal ends `wait` too
done
# A preempted job is queued again by Slurm; at the time limit the job must ask. Where that is not allowed the task ends
# here, and `peclet ingest` puts its seeds back.
if [ "$limit" = yes ] && [ "$code" -eq 75 ]; then
  scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID"
fi
exit "$code"
