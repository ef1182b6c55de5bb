"""fake_commands.py COMMAND [WORD...]

Answers like a command of PBS or LSF, for batch_answers.py. The folder $FAKE_BATCH has the answers, answers.json: for
each command a list, of which each call takes the next; the last one stays. An answer has "out", "err" and "code"; that
of qselect or bjobs may have "jobs" instead, of which the options select some. Each call is noted in calls.json.
"""
import fcntl
import getopt
import json
import os
import sys

ENDED = ("DONE", "EXIT", "ZOMBI")


def qselect(words, jobs):
    """Returns what qselect(1B) prints of `jobs`, each with "id", "name", "state" and, if it is an array, "tasks"."""
    options = dict(getopt.getopt(words, "TN:s:")[0])
    states = options.get("-s", "BEHQRSTUWX")
    lines = []
    for job in jobs:
        number, tasks = job["id"], job.get("tasks")
        if options.get("-N", job["name"]) != job["name"]:
            continue
        if tasks is None:
            # A suspended job is a running one for the server, unless the list begins with S or R.
            suspended = job["state"] == "S"
            listed = ("R" if suspended else job["state"]) in states
            if suspended and states[0] in "SR":
                listed = states[0] == "S"
            lines += [f"{number}.tide"] if listed else []
        elif "-T" in options:
            lines += [f"{number}[{index}].tide" for index, state in enumerate(tasks) if state in states]
        elif job["state"] in states:
            lines.append(f"{number}[].tide")
    return {"out": "".join(line + "\n" for line in lines)}


def bjobs(words, jobs, code):
    """Returns what bjobs of LSF 10.1 prints of `jobs`, each with "id", "name" and the states of "tasks"."""
    given, words = {}, list(words)
    while words:
        option = words.pop(0)
        given[option] = words.pop(0) if option in ("-o", "-J") else True
    assert set(given) <= {"-a", "-noheader", "-o", "-J"}, given
    lines = [] if "-noheader" in given else [given["-o"].upper()]
    for job in jobs:
        if given["-J"] not in (job["name"], "*"):
            continue
        for index, state in enumerate(job["tasks"], 1):
            if "-a" in given or state not in ENDED:
                fields = {"jobid": job["id"], "jobindex": str(index), "stat": state}
                lines.append(" ".join(fields[name] for name in given["-o"].split()))
    if not lines:
        return {"err": f"Job <{given['-J']}> is not found\n", "code": code}
    return {"out": "".join(line + "\n" for line in lines)}


def main(command, *words):
    folder = os.environ["FAKE_BATCH"]
    call = {"command": command, "words": words, "folder": os.getcwd(), "environment": dict(os.environ)}
    if command == "bsub":
        call["input"] = sys.stdin.read()
    with open(os.path.join(folder, "calls.json"), "a+", encoding="utf-8") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        file.seek(0)
        before = sum(json.loads(line)["command"] == command for line in file)
        file.write(json.dumps(call) + "\n")
    with open(os.path.join(folder, "answers.json"), encoding="utf-8") as file:
        answers = json.load(file)[command]
    answer = answers[min(before, len(answers) - 1)]
    if "jobs" in answer:
        if command == "qselect":
            answer = qselect(words, answer["jobs"])
        else:
            answer = bjobs(words, answer["jobs"], answer.get("code", 255))
    sys.stdout.write(answer.get("out", ""))
    sys.stderr.write(answer.get("err", ""))
    return answer.get("code", 0)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
