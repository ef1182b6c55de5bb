#!/bin/sh
# largest.sh: prints the number of tasks that one array may have. PBS's max_array_size is 10000 unless set.
qstat -Bf | awk '$1 == "max_array_size" { most = $3 } END { if (!NR) exit 1; print most ? most : 10000 }'
