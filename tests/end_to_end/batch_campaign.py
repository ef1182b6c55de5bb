#!/usr/bin/python3
"""batch_campaign.py PROGRAMS

Runs campaigns through the templates of PBS and LSF (peclet hand-over pbs, lsf). Their commands are this program: they
start the tasks of a job on this machine at once. Tasks are killed and cancelled meanwhile. The canonical export must be
that of `peclet run`, with no realisation lost or counted twice.
"""
import contextlib
import fcntl
import json
import os
import re
import signal
import subprocess
import sys
import tempfile

HERE = os.path.realpath(__file__)
sys.path[:0] = [os.path.dirname(HERE), os.path.join(os.path.dirname(HERE), "..", "templates")]
from campaign_folder import comes_true, processes_with  # noqa: E402
from drill.campaign import alive  # noqa: E402
from fake_commands import bjobs, qselect  # noqa: E402
from slurm_campaign import Campaign  # noqa: E402

COMMANDS = {"pbs": ("qsub", "qselect", "qdel", "qstat"), "lsf": ("bsub", "bjobs", "bkill", "bparams")}
LARGEST = 4  # tasks of an array


@contextlib.contextmanager
def known_jobs():
    """Gives the list of jobs, each with id, name and processes; what is changed in it is kept."""
    with open(os.path.join(os.environ["FAKE_BATCH"], "jobs"), "a+") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        file.seek(0)
        jobs = json.loads(file.read() or "[]")
        yield jobs
        file.truncate(0)
        json.dump(jobs, file)


def start(name, script, variables):
    """Starts a job with a task for each of the variables, and returns its number."""
    quiet = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    tasks = [
        subprocess.Popen(["bash", script], env={**os.environ, **own}, start_new_session=True, **quiet).pid
        for own in variables
    ]
    with known_jobs() as jobs:
        jobs.append({"id": str(len(jobs) + 1), "name": name, "processes": tasks})
        return jobs[-1]["id"]


def end(processes):
    for process in filter(alive, processes):
        os.killpg(process, signal.SIGTERM)


def qsub(*words):
    name, script = words[words.index("-N") + 1], words[-1]
    array = words[words.index("-J") + 1] if "-J" in words else ""
    indices = range(int(array.split("-")[1]) + 1) if array else ()
    number = start(name, script, [{"PBS_ARRAY_INDEX": str(i)} for i in indices] or [{}])
    return f"{number}{'[]' if array else ''}.tide\n"


def listed(jobs, lives, has_ended):
    return [{**job, "tasks": [lives if alive(process) else has_ended for process in job["processes"]]} for job in jobs]


def bsub():
    script = sys.stdin.read()
    name, last = re.search(r'^#BSUB -J "(.*)\[1-(\d+)\]"$', script, re.MULTILINE).groups()
    path = os.path.join(os.environ["FAKE_BATCH"], name)
    with open(path, "w") as file:
        file.write(script)
    number = start(name, path, [{"LSB_JOBINDEX": str(i + 1)} for i in range(int(last))])
    return f"Job <{number}> is submitted to default queue <normal>.\n"


def answer(command, words):
    """Returns what a command of PBS or LSF prints, and does what it does."""
    if command in ("qsub", "bsub"):
        return qsub(*words) if command == "qsub" else bsub()
    if command == "qstat":
        return f"Server: tide\n    max_array_size = {LARGEST}\n"
    if command == "bparams":
        return f"MAX_JOB_ARRAY_SIZE = {LARGEST}\n"
    with known_jobs() as jobs:
        if command == "qselect":
            plain = [job for job in listed(jobs, "R", "X") if len(job["tasks"]) == 1]
            arrays = [job for job in listed(jobs, "R", "X") if len(job["tasks"]) > 1]
            plain = [{"id": job["id"], "name": job["name"], "state": job["tasks"][0]} for job in plain]
            return qselect(words, plain + arrays)["out"]
        if command == "bjobs":
            said = bjobs(words, listed(jobs, "RUN", "DONE"), 255)
            return said.get("out", "") + said.get("err", "")
        chosen = [job for job in jobs if words[0].split("[")[0].split(".")[0] == job["id"] or job["name"] in words]
        for job in chosen:
            end(job["processes"])
        return "".join(f"Job <{job['id']}> is being terminated\n" for job in chosen) or "No job found\n"


def campaign_of(system, folder, document=None, environment=None):
    """Returns a campaign in a folder in which the commands of the system are."""
    campaign = Campaign(os.path.abspath(sys.argv[1]), os.path.join(folder, system), document, environment)
    campaign.system = system
    os.makedirs(campaign.place("commands"))
    for command in COMMANDS[system]:
        os.symlink(HERE, campaign.place("commands", command))
    path = campaign.place("commands") + ":" + campaign.environment.get("PATH", os.environ["PATH"])
    campaign.environment.update(FAKE_BATCH=campaign.folder, PATH=path)
    return campaign


def tasks_of(campaign):
    with open(campaign.place("jobs")) as file:
        return [process for job in json.loads(file.read() or "[]") for process in job["processes"] if alive(process)]


def run(campaign):
    """Runs the campaign; kills a task, and takes the seeds of jobs back once."""
    campaign.do(*campaign.hand_over("--seeds-per-task", "2"))
    assert comes_true(lambda: len(tasks_of(campaign)) > 1), campaign.log()
    campaign.do("ingest", "drill.json", "--cancel")
    assert not tasks_of(campaign), "cancelled tasks run"
    owner = campaign.start(*campaign.follow("--seeds-per-task", "2"))
    assert comes_true(lambda: tasks_of(campaign)), campaign.log()
    os.killpg(tasks_of(campaign)[0], signal.SIGKILL)
    assert owner.wait(200) == 0, campaign.log()
    assert campaign.lost() == 0 and campaign.double() == 0 and campaign.blamed() == 0, campaign.log()
    assert campaign.ask("SELECT max(tasks) FROM bundle") == LARGEST, "arrays of another size"
    assert campaign.ask("SELECT count(*) FROM bundle_seed WHERE outcome IN ('returned', 'drained')") > 0, campaign.log()
    assert not processes_with("FAKE_BATCH", campaign.folder), "processes are left"


def main():
    with tempfile.TemporaryDirectory() as folder:
        expected = Campaign(os.path.abspath(sys.argv[1]), os.path.join(folder, "local")).run_locally().export()
        for system in COMMANDS:
            campaign = campaign_of(system, folder)
            try:
                run(campaign)
            finally:
                campaign.stop()
            assert campaign.export() == expected, f"{system}: other results"
            print(f"{system}: {campaign.ended()} results, the same bytes as without it", flush=True)


if __name__ == "__main__":
    if os.path.basename(sys.argv[0]) in COMMANDS["pbs"] + COMMANDS["lsf"]:
        sys.stdout.write(answer(os.path.basename(sys.argv[0]), sys.argv[1:]))
    else:
        main()
