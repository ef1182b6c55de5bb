#!/bin/sh
# submit.sh NAME JOB_SCRIPT [OPTION...]: hands the script in and prints the job's number. Exit code 75 when the connection
# failed on the way, so that nobody knows whether the job was taken; any other but 0 when it was not.
name=$1
folder=$(cd "$(dirname "$2")" && pwd) || exit 1
script=$folder/$(basename "$2")
shift 2
for word; do
  case $word in
    -Jd | -Jd\ *) ;;  # a description
    -J* | -pack | -json | -yaml | -jsdl*)
      printf '%s: the name and the array of a job are how it is found again\n' "$word" >&2
      exit 2 ;;
    -I* | -K | -XF | -h | -help | -V)
      printf '%s: bsub would not print the number of the job and leave\n' "$word" >&2
      exit 2 ;;
  esac
done
unset BSUB_QUIET BSUB_QUIET2 BSUB_BLOCK BSUB_CHK_RESREQ  # no number, no end, no job
cd "$folder/logs" || exit 1  # where LSF leaves its report
said=$(bsub "$@" <"$script" 2>&1)
code=$?
job=$(printf '%s\n' "$said" | sed -n 's/.*Job <\([0-9]\{1,\}\)> is submitted to .*/\1/p' | tail -n 1)
if [ -n "$job" ]; then
  printf '%s\n' "$job"
  # LSF may answer queries from a copy that is some seconds old.
  for _ in 1 2 3 4 5 6 7 8 9 10; do
    sh "$folder/query.sh" "$name" 2>/dev/null | grep -q "^$job " && break
    sleep 2
  done
  exit 0
fi
[ -z "$said" ] || printf '%s\n' "$said" >&2
case $said in
  *"onnection refused"* | *"connect call"*) ;;  # nothing was sent
  *"rotocol"* | *"XDR"* | *"sending/receiving"* | *"ommunication"* | *"onnection"* | *"End of file"* | *"Broken pipe"*)
    exit 75 ;;
esac
case $said in
  *"index too large"* | *"array size"* | *"threshold"* | *"job limit"*)
    printf 'fewer tasks at a time may be allowed: --largest-array N, or --seeds-per-task N for more seeds in each\n' >&2 ;;
esac
case $said in *"ob not submitted"*) exit 1 ;; esac
case $code in 126 | 127) exit 1 ;; esac  # there is no bsub
exit 75
