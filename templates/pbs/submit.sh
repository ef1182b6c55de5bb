#!/bin/sh
# submit.sh NAME JOB_SCRIPT [OPTION...]: hands the script in and prints the job's number. Exit code 75 when the connection
# failed on the way, so that nobody knows whether the job was taken; any other but 0 when it was not.
name=$1
folder=$(cd "$(dirname "$2")" && pwd) || exit 1
script=$folder/$(basename "$2")
shift 2
refuse() {
  printf '%s: %s\n' "$1" "$2" >&2
  exit 2
}
# The server that gets the job is kept for query.sh and cancel.sh.
server=${PBS_SERVER:-$PBS_DEFAULT}
option=
for word; do
  word=$option$word
  option=
  case $word in
    -[aAcCejJklmMNopPqrRSuvW]) option=$word ;;  # its value is the next word
    -N* | -J*) refuse "$word" 'the name and the array of a job are how it is found again' ;;
    -q*@*) server=${word#*@} ;;
    -I* | -G* | -X* | -z* | --* | -Wblock* | -W*[,\ ]block* | -Winteractive* | -W*[,\ ]interactive*)
      refuse "$word" 'qsub would not print the number of the job and leave' ;;
    -[fhV]?*) refuse "$word" 'options must be words of their own' ;;
    -*) ;;
    *) refuse "$word" 'is no option; qsub would take it for the script' ;;
  esac
done
[ -z "$option" ] || refuse "$option" 'lacks its value'
last=$(sed -n 's/^# tasks: 0-\([0-9]\{1,\}\)$/\1/p' "$script")
[ -n "$last" ] || refuse "$script" 'must have a line "# tasks: 0-LAST"'
printf '%s\n' "$server" >"$folder/server" || exit 1
array=
[ "$last" -eq 0 ] || array=0-$last  # PBS refuses an array of one task
unset PBS_DPREFIX PBS_ARRAY_INDEX  # another mark than #PBS; and this process may be a task of an array itself
cd "$folder/logs" || exit 1  # where PBS leaves what it has to say itself
said=$(qsub -f -N "$name" ${array:+-J "$array"} "$@" "$script" 2>&1)
code=$?
job=$(printf '%s\n' "$said" | sed -n '/^[0-9]\{1,\}\(\[\]\)\{0,1\}\(\.[^ ]*\)\{0,1\}$/p' | tail -n 1)
if [ "$code" -eq 0 ] && [ -n "$job" ]; then
  printf '%s\n' "$job"
  exit 0
fi
[ -z "$said" ] || printf '%s\n' "$said" >&2
case $said in
  *"cannot connect to server"*) exit 1 ;;  # nothing was sent
  *"protocol"* | *"Protocol"* | *"End of File"* | *"Premature end of message"* | *"submitting job"*) exit 75 ;;
  *"would exceed"* | *"Maximum number of jobs"* | *"size limit"*)
    printf 'fewer tasks at a time may be allowed: --largest-array N, or --seeds-per-task N for more seeds in each\n' >&2 ;;
esac
# qsub leaves with PBS's error number, modulo 256: none of them is in 129 to 152, and 183 is a protocol error.
case $code in 0 | 129 | 1[34]? | 15[012] | 183) exit 75 ;; esac
exit 1
