#!/bin/sh
# submit.sh NAME JOB_SCRIPT [OPTION...]: hands the script in and prints the job's number. Exit code 75 when the connection
# failed on the way, so that nobody knows whether the job was taken; any other but 0 when it was not.
script=$2
shift 2
exec 3>&1
said=$(sbatch --parsable "$@" "$script" 2>&1 >&3)
code=$?
[ -z "$said" ] || printf '%s\n' "$said" >&2
[ "$code" -ne 0 ] || exit 0
case $said in
  *"connect failure"* | *"Connection refused"*) exit "$code" ;;  # nothing was sent
  *"timed out"* | *"send failure"* | *"receive failure"* | *"shutdown failure"* | *"Unable to contact"* | *"Zero Bytes"* | \
    *"Connection reset"* | *"Broken pipe"* | *"Unexpected message"* | *"not connected"*) exit 75 ;;
esac
exit "$code"
