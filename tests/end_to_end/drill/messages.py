"""Messages by socket and spool: frames and files that are repeated, reordered, truncated, too large or
foreign; and engines that hang, crash or lie.
"""
import json
import os
import re

from drill.board import Board
from drill.campaign import Campaign

FRAMES = ["twice", "early", "late", "truncate", "oversize", "garble", "rehello"]
ENGINES = ["hang", "lie", "swap", "nan", "crash", "exit", "kill", "mute", "refuse"]


def engine_faults(lab, tally, chance, times, faults):
    """Makes six seeds of each point fail once or twice at a random step; the third try is sound."""
    for _ in range(times):
        kinds = " ".join(
            f"{chance.choice(faults)}:{seed}x{chance.randint(1, 2)}" for seed in chance.sample(range(12), 6)
        )
        campaign = Campaign(lab, lease=1, steps=10, step_ms=1, checkpoint=0.003)
        code = campaign.run({"PECLET_FAKE_FAULTS": kinds, "PECLET_FAKE_FAULT_STEP": str(chance.randint(0, 9))})
        tally.expect(campaign, code == lab.undisturbed(campaign)[0], f"{kinds}: exit code {code}")
        given_up = campaign.count("SELECT count(*) FROM realisation WHERE state = 'quarantined'")
        tally.expect(campaign, given_up == 0, f"{kinds}: {given_up} seeds were given up")
        tally.judge(campaign, 6)


def crash_at_each_step(lab, tally, chance, steps):
    for step in steps:
        campaign = Campaign(lab, steps=10, step_ms=1, checkpoint=0.001)
        faults = " ".join(f"crash:{seed}x2" for seed in range(12))
        campaign.run({"PECLET_FAKE_FAULTS": faults, "PECLET_FAKE_FAULT_STEP": str(step)})
        crashes = campaign.count("SELECT count(*) FROM attempt WHERE outcome = 'crashed'")
        tally.expect(campaign, crashes >= 8, f"{crashes} crashes at step {step}")
        tally.judge(campaign, crashes)


def other_answer(lab, tally, chance, times):
    """Gives a late worker another result for its seed: exit code 6 from then on, numbers unchanged."""
    for _ in range(times):
        campaign = Campaign(lab, workers=1)
        board = Board(campaign.folder)
        fault = {"call": "rename", "path": "/spool/", "number": 1, "action": "wait"}
        owner = campaign.start({**board.environment(lab.shim, role="worker", **fault), "PECLET_FAKE_DRIFT": "1"})
        board.wait(owner)
        owner.kill()
        owner.wait()
        code = campaign.run()
        tally.expect(campaign, code == lab.undisturbed(campaign)[0], f"before it woke up: exit code {code}")
        board.switch_off()
        campaign.settle()
        tally.tried += 1
        code = campaign.run()
        tally.expect(campaign, code == 6, f"a point with two answers ended with exit code {code}")
        tally.expect(campaign, campaign.count("SELECT total(suspect) FROM point") == 1, "no point is suspect")
        kept = [name for name in os.listdir(campaign.path("spool", "rejected")) if "@" not in name]
        tally.expect(campaign, len(kept) == 1, f"kept aside: {kept}, not the second answer")
        tally.judge(campaign, 0, code=6)


def spool_files(lab, tally, chance, times):
    """Kills an owner beside a full spool, and adds foreign files to it."""
    for _ in range(times):
        campaign = Campaign(lab)
        board = Board(campaign.folder)
        fault = {"call": "remove", "path": "/spool/", "number": chance.randint(1, 12), "action": "cut"}
        campaign.run(board.environment(lab.shim, role="owner", **fault))
        campaign.settle()
        campaign.acknowledge()
        spool = campaign.path("spool")
        name = next(name for name in os.listdir(spool) if re.fullmatch(r"[0-9a-f]{16}-\d+-\d+\.json", name))
        put = litter(spool, name, chance)
        campaign.run()
        left = [name for name in os.listdir(spool) if name.endswith(".json")]
        left = [name for name in left if "folder" not in name and "nowhere" not in name]
        tally.expect(campaign, not left, "files were left in the spool")
        kept = len([name for name in os.listdir(os.path.join(spool, "rejected")) if "@" not in name])
        tally.expect(campaign, kept == put, f"{kept} files were kept aside, not {put}")
        tally.judge(campaign, put)


def litter(spool, name, chance):
    """Adds files beside the complete one. Returns the number that must be set aside."""
    with open(os.path.join(spool, name), "rb") as f:
        good = f.read()
    point, seed, attempt = name.removesuffix(".json").split("-")
    other = f"{(int(seed) + 1) % 12:06}"
    result = json.loads(good)
    result["mean"]["relative_viscosity"] = 99
    lie = json.dumps(result).encode()
    foreign = json.dumps(dict(json.loads(good), point="f" * 64)).encode()
    bad = {
        f"{point}-{seed}-9001.json": good[: chance.randint(1, len(good) - 1)],  # truncated
        f"{point}-{seed}-9002.json": b"",
        f"{point}-{seed}-9003.json": chance.randbytes(len(good)),
        f"{point}-{other}-9004.json": lie,  # wrong, under the name of another seed
        f"{'0' * 16}-{seed}-9005.json": good,  # under the name of another point
        "of-another-campaign.json": foreign,
        "a list.json": b"[" + good + b"]",
        "not-utf-8-\udcff.json": b"\xff\xfe",
        "too-large.json": b"{",
    }
    copies = {f"{point}-{seed}-{9100 + copy}.json": good for copy in range(3)}
    unfinished = {f"{point}-{other}-9200.json.{2 ** 22 + 1}.0.tmp": good[:100]}  # dead writer
    for file, content in {**bad, **copies, **unfinished}.items():
        with open(os.path.join(spool, file), "wb") as f:
            f.write(content)
    os.truncate(os.path.join(spool, "too-large.json"), 1 << 40)  # sparse
    os.mkdir(os.path.join(spool, "folder.json"))
    os.symlink("/nonexistent", os.path.join(spool, "nowhere.json"))
    return len(bad)
