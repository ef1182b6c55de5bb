#!/bin/bash
# Runs a campaign in one job of Slurm, on one node or several:
#
#   sbatch --job-name=friction --nodes=3 --ntasks-per-node=16 nodes.sh friction.json [option of `peclet run` ...]
#
# The database is on the first node. Each task of the job is a worker; without --ntasks-per-node there are
# as many as processors, over --cpus-per-task.
# Backups are in friction.saved beside friction.json: one every ten minutes, and one at the end. The job continues from
# there when it is queued again, and when it is submitted again. `peclet` must be in PATH.
#SBATCH --job-name=peclet
#SBATCH --dependency=singleton
#SBATCH --nodes=1
#SBATCH --exclusive
#SBATCH --time=24:00:00
#SBATCH --signal=B:USR1@300
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=%x.log

campaign=${1:?names no campaign: sbatch nodes.sh friction.json}
shift
saved=${campaign%.json}.saved
job=${TMPDIR:-/tmp}/peclet-$SLURM_JOB_ID   # on the first node
node=$job-${SLURM_RESTART_COUNT:-0}        # of this start alone: the one before may still be leaving
folder=$node/campaign.peclet

mkdir -p "$node" || exit
trap 'rm -rf "$node"' EXIT
if [ -e "$saved/backup.db" ]; then
  peclet restore "$saved" "$campaign" --directory "$folder" || exit
  for start in "$job"-*; do [ "$start" = "$node" ] || rm -rf "$start"; done  # of starts that were killed
fi
save() {
  [ ! -e "$folder/campaign.db" ] || flock "$node/saving" peclet backup "$folder" "$saved" --checkpoints
}

# SLURM_JOB_CPUS_PER_NODE is as 16(x2),8.
processors=$(tr ',' '\n' <<<"$SLURM_JOB_CPUS_PER_NODE" | awk -F '[(x)]' '{ n += $1 * ($3 ? $3 : 1) } END { print n }')
threads=${SLURM_CPUS_PER_TASK:-1}
workers=(--workers "${SLURM_NTASKS:-$((processors / threads))}" --threads "$threads")
# Without --mem=0 the first worker of a node takes all memory of the job there, and the others wait.
[ "$SLURM_JOB_NUM_NODES" -eq 1 ] || workers+=(--launch 'srun --exact --mem=0 -N1 -n1 -c{threads}')
peclet run "$campaign" --directory "$folder" "${workers[@]}" --quiet "$@" &
run=$!
(while sleep 600; do save; done) &
saver=$!
limit=no
trap 'limit=yes; kill -TERM "$run" 2>/dev/null' USR1  # five minutes before the time limit
trap 'kill -TERM "$run" 2>/dev/null' TERM             # a preemption, or scancel --batch --signal=TERM
while :; do
  wait "$run"
  code=$?
  kill -0 "$run" 2>/dev/null || break  # a signal ends `wait` too
done
kill "$saver" 2>/dev/null
save || {
  trap - EXIT
  echo "nothing could be saved: the campaign is in $folder on $(hostname)"
  exit 1
}
[ "$limit" = no ] || [ "$code" -ne 75 ] || scontrol requeue "$SLURM_JOB_ID"
exit "$code"
