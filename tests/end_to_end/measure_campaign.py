#!/usr/bin/python3
"""measure_campaign.py PROGRAMS

Tests a campaign whose observable is a script of the user's own. It is refused before anything runs if the script is
absent or does not fit. Two workers, one of which is killed, launched workers and the tasks of a batch system give the
numbers of one worker that works undisturbed. The script travels with the scene: it may be changed or removed while the
campaign runs, and another script makes another point. No python3 outlives its engine, even if both are busy when the
engine is killed.
"""
import json
import os
import shutil
import signal
import sys
import tempfile
import time

import batch_campaign
from campaign_folder import SMALL_SCENE, CampaignFolder

EXAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "measure")
CAMPAIGN = {
    "name": "flow",
    "scene": SMALL_SCENE | {"observables": ["measure", "fabric"], "measure": {"script": "scripts/mine.py"}},
    "sweep": [{"set": "/volume_fraction", "values": [0.35, 0.45]}],
    "target": {"observable": "measure/largest_cluster", "absolute_tolerance": 10},
    "realisations": {"minimum": 8, "maximum": 8},
}
PYTHON = {"PATH": "/usr/bin:" + os.environ["PATH"]}  # Debian's, with NumPy and SciPy
BUSY = """
import os
quantities = {"x": {}}
def measure(frame):
    with open(os.environ["PIDS"], "a") as file: file.write(f"{os.getpid()} {os.getppid()}\\n")
    while True: pass
"""


def check(holds, *what):
    if not holds:
        raise SystemExit("measure_campaign.py: " + " ".join(map(str, what)))


def write_script(folder, text):
    os.makedirs(os.path.join(folder, "scripts"), exist_ok=True)
    with open(os.path.join(folder, "scripts", "mine.py"), "w") as file:
        file.write(text)


def text_of(*names):
    with open(os.path.join(EXAMPLES, *names)) as file:
        return file.read()


def example():
    return text_of("clusters.py")


def line_of(piece):
    return example()[: example().index(piece)].count("\n") + 1


def campaign_in(programs, folder, script, **changes):
    campaign = CampaignFolder(programs, folder, CAMPAIGN | changes, PYTHON)
    if script is not None:
        write_script(folder, script)
    return campaign


def exported(campaign):
    said = campaign.say("export", "--json", campaign.file, text=True)
    check(said.returncode == 0, said.stderr)
    return json.loads(said.stdout)["points"]


def refusals(programs, folder):
    good = example()
    target = {"target": CAMPAIGN["target"] | {"observable": "measure/largest_clutser"}}
    swept = {"sweep": [{"set": "/measure/script", "values": ["scripts/mine.py", "b.py"]}]}
    for number, (script, changes, pieces) in enumerate(
        [
            (None, {}, ["flow.json: /scene/measure/script:", "scripts/mine.py", "cannot be read: No such file"]),
            (
                good.replace("def measure(frame):", "def measure(frame)"),
                {},
                [f"scripts/mine.py, line {line_of('def measure')}: SyntaxError"],
            ),
            (good.replace("def measure", "def count"), {}, ["/scene/measure/script: ", "must have a function measure"]),
            (good, target, ["/target/observable: measure/largest_clutser", "did you mean measure/largest_cluster?"]),
            (good, swept, ["/sweep/0/set: /measure/script: must not be swept"]),
            ("#" * 70000, {}, ["must have at most 65536 bytes"]),
        ]
    ):
        campaign = campaign_in(programs, os.path.join(folder, f"refused{number}"), script, **changes)
        for verb in "validate", "run":
            said = campaign.say(verb, campaign.file, text=True)
            check(said.returncode == 2, verb, "left with", said.returncode, said.stdout, said.stderr)
            check(len(said.stderr.splitlines()) == 1, said.stderr)
            for piece in pieces:
                check(piece in said.stderr, repr(piece), "is not in", said.stderr)
        check(not os.path.exists(campaign.data), "something was written")


def same_numbers(programs, folder):
    quiet = campaign_in(programs, os.path.join(folder, "quiet"), example())
    said = quiet.say("run", quiet.file, "--workers=1", text=True)
    check(said.returncode == 0, said.stdout, said.stderr)
    disturbed = campaign_in(programs, os.path.join(folder, "disturbed"), example())
    with disturbed.start("run", disturbed.file, "--workers=2") as run:
        while disturbed.ended() < 3:
            check(run.poll() is None, "the run ended early")
            time.sleep(0.05)
        write_script(disturbed.folder, "this is no Python\n")
        run.send_signal(signal.SIGTERM)
        check(run.wait() in (0, 75), run.returncode)
    write_script(disturbed.folder, example())
    said = disturbed.say("run", disturbed.file, "--workers=2", text=True)
    check(said.returncode == 0, said.stdout, said.stderr)
    shutil.rmtree(disturbed.place("scripts"))  # everything is in the database now
    launched = campaign_in(programs, os.path.join(folder, "launched"), example())
    said = launched.say("run", launched.file, "--workers=2", "--launch=env", text=True)
    check(said.returncode == 0, said.stdout, said.stderr)
    bundled = batch_campaign.campaign_of("pbs", folder, CAMPAIGN | {"name": "drill"}, PYTHON)
    write_script(bundled.folder, example())
    bundled.do(*bundled.follow("--seeds-per-task", "4"))
    points = exported(quiet)
    check(len(points) == 2, points)
    for other in disturbed, launched, bundled:
        for one, again in zip(points, exported(other)):
            for name in "measure/largest_cluster", "measure/clusters", "fabric/near":
                check(one["quantities"][name] == again["quantities"][name], name, "differs in", other.folder)
    for point in points:
        largest = point["quantities"]["measure/largest_cluster"]
        check(0 < largest["mean"] < 1 and largest["count"] == 8 and largest["standard_error"] > 0, largest)
    said = disturbed.say("doctor", disturbed.file, text=True)
    check(said.returncode == 0, said.stdout, said.stderr)

    write_script(quiet.folder, example().replace(' / frame.count, "cl', ' / 60, "cl'))
    said = quiet.say("validate", "--json", quiet.file, text=True)
    check(said.returncode == 0, said.stderr)


def failing_seed(programs, folder):
    campaign = campaign_in(programs, os.path.join(folder, "failing"), example().replace("links =", "links = 1 / 0 #"))
    said = campaign.say("run", campaign.file, "--workers=2", text=True)
    check(said.returncode == 3, said.returncode, said.stdout, said.stderr)
    said = campaign.say("explain", campaign.file, text=True)
    wanted = f"scripts/mine.py, line {line_of('links =')}: ZeroDivisionError: division by zero"
    check(wanted in said.stdout, repr(wanted), "is not in", said.stdout)


def is_there(process):
    try:
        with open(f"/proc/{process}/stat") as file:
            return file.read().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


def no_orphan(programs, folder):
    """Kills the engine while the script is busy."""
    os.makedirs(folder)
    pids = os.path.join(folder, "pids")
    campaign = campaign_in(
        programs, os.path.join(folder, "busy"), BUSY, sweep=[], target=CAMPAIGN["target"] | {"observable": "measure/x"}
    )
    with campaign.start("run", campaign.file, "--workers=1", environment={"PIDS": pids}) as run:
        while not os.path.exists(pids) or not os.path.getsize(pids):
            check(run.poll() is None, "the run ended early")
            time.sleep(0.05)
        with open(pids) as file:
            script, engine = map(int, file.readline().split())
        os.kill(engine, signal.SIGKILL)
        until = time.monotonic() + 60
        while is_there(script):
            check(time.monotonic() < until, "python3 outlives its engine")
            time.sleep(0.02)
        run.send_signal(signal.SIGKILL)
    with open(pids) as file:
        later = [int(line.split()[0]) for line in file]
    while any(map(is_there, later)):
        check(time.monotonic() < until, "python3 outlives the owner")
        time.sleep(0.02)


def main():
    programs = sys.argv[1]
    check(example() in text_of("..", "measure.md"), "the page shows another clusters.py")
    with tempfile.TemporaryDirectory() as folder:
        for case in refusals, same_numbers, failing_seed, no_orphan:
            case(programs, os.path.join(folder, case.__name__))


if __name__ == "__main__":
    main()
