#!/bin/sh
# largest.sh: prints the number of tasks that one array may have. Slurm's MaxArraySize is one above the largest index.
scontrol show config | awk '$1 == "MaxArraySize" { print $3 - 1; found = 1 } END { exit !found }'
