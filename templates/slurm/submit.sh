#!/bin/sh
# submit.sh NAME JOB_SCRIPT [OPTION...]: hands the script in and prints the job's number.
script=$2
shift 2
sbatch --parsable "$@" "$script"
