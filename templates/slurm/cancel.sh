#!/bin/sh
# cancel.sh NAME: ends the jobs of this name, waiting or running.
unset SLURM_CLUSTERS $(env | sed -n 's/^\(SCANCEL_[A-Z0-9_]*\)=.*/\1/p')
clusters=$(cat "$(dirname "$0")/clusters" 2>/dev/null)  # as submit.sh leaves them
scancel ${clusters:+--clusters="$clusters"} --me --name="$1"
