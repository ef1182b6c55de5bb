#!/bin/sh
# submit.sh NAME JOB_SCRIPT [OPTION...]: hands the script in and prints the job's number. Exit code 75 when the connection
# failed on the way, so that nobody knows whether the job was taken; any other but 0 when it was not.
script=$2
shift 2
unset SBATCH_JOB_NAME SBATCH_ARRAY_INX SBATCH_WAIT  # sbatch would put them above the script's
# The clusters in which the job may be are kept for query.sh and cancel.sh, which ask this one otherwise. sbatch takes
# those of its options, else of its environment, else of the script.
clusters=${SBATCH_CLUSTERS:-${SLURM_CLUSTERS:-$(sed -n 's/^#SBATCH[[:space:]]\{1,\}\(--clusters[= ]\|-M *\)\([^[:space:]]*\).*/\2/p' "$script" | tail -n 1)}}
before=
for word; do
  case $before in
    -M | --cl | --clu | --clus | --clust | --cluste | --cluster | --clusters) clusters=$word ;;
  esac
  case $word in
    --cl=* | --clu=* | --clus=* | --clust=* | --cluste=* | --cluster=* | --clusters=*) clusters=${word#*=} ;;
    -M?*) clusters=${word#-M} ;;
    -J* | --job | --job-* | --job=* | -a* | --ar | --arr* | --ar=*)
      printf '%s: the name and the array of a job are how it is found again\n' "$word" >&2
      exit 2 ;;
    -W | --wait | -Q | --qui* | --test* | --wrap*)
      printf '%s: sbatch would not submit the script at once, or not say its number\n' "$word" >&2
      exit 2 ;;
  esac
  before=$word
done
[ -z "$clusters" ] || printf '%s\n' "$clusters" >"$(dirname "$0")/clusters" || exit 1
exec 3>&1
said=$(sbatch --parsable "$@" "$script" 2>&1 >&3)
code=$?
[ -z "$said" ] || printf '%s\n' "$said" >&2
[ "$code" -ne 0 ] || exit 0
case $said in
  *"connect failure"* | *"Connection refused"*) exit "$code" ;;  # nothing was sent
  *"timed out"* | *"send failure"* | *"receive failure"* | *"shutdown failure"* | *"Unable to contact"* | *"Zero Bytes"* | \
    *"Connection reset"* | *"Broken pipe"* | *"Unexpected message"* | *"not connected"*) exit 75 ;;
  *"submit limit"* | *SubmitJob* | *MaxArraySize* | *"array specification"*)
    printf 'fewer tasks at a time may be allowed: --largest-array N, or --seeds-per-task N for more seeds in each\n' >&2 ;;
esac
exit "$code"
