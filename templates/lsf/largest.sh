#!/bin/sh
# largest.sh: prints the number of tasks that one array may have. LSF's is 1000 unless set.
bparams -a | awk '$1 == "MAX_JOB_ARRAY_SIZE" { print $3; found = 1 } END { exit !found }'
