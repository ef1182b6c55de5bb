"""Calls that fail below SQLite, and file systems that are full for a while."""
import collections
import ctypes
import itertools
import os
import subprocess

from campaign_folder import BLAMED
from drill.board import Board
from drill.campaign import FAKE, PATIENCE, Campaign, ends_within
from drill.kills import calls_of

# The shortest campaign: each of its calls can fail in turn.
SHORT = dict(FAKE, sweep=[{"set": "/peclet", "values": [1]}], realisations={"minimum": 2, "maximum": 2})

CLONE_NEWNS, CLONE_NEWUSER = 0x00020000, 0x10000000


def failing_calls(lab, tally, chance, call, action, path, stride=1, role="owner", document=SHORT):
    """Makes the nth call fail, for all n: the run ends with exit code 1 and a message, or continues.
    Unreadable data may also be called damaged (6), as by SQLite."""
    allowed, codes = {1, 6} if call == "read" else {1}, collections.Counter()
    for number in calls_of(stride, chance):
        campaign = Campaign(lab, document, workers=1)
        board = Board(campaign.folder)
        code = campaign.run(board.environment(lab.shim, role=role, call=call, path=path, number=number, action=action))
        if not board.struck:
            campaign.close()
            break
        codes[code] += 1
        log = campaign.log().splitlines()
        what = f"{board.what} (call {number})"
        tally.expect(campaign, code in allowed | {lab.undisturbed(campaign)[0]}, f"{what}: exit code {code}")
        spoke = any(line.startswith("peclet: ") and len(line) > 20 for line in log)
        tally.expect(campaign, code not in allowed or spoke, f"{what}: no message")
        tally.judge(campaign)
    tally.remarks.append("exit codes " + ", ".join(f"{code}: {count}" for code, count in sorted(codes.items())))


def passing_failures(lab, tally, chance, calls, actions, path, stride=1):
    """Makes the owner's nth call on files of realisations fail once, for all n. It must wait, continue by
    itself and blame no seed. A readable result must not be dropped because the disk failed."""
    codes = collections.Counter()
    for call, action in itertools.product(calls, actions):
        for number in calls_of(stride, chance):
            campaign = Campaign(lab, SHORT, workers=1)
            board = Board(campaign.folder)
            fault = {"call": call, "path": path, "number": number, "action": action}
            code = campaign.run(board.environment(lab.shim, role="owner", **fault))
            if not board.struck:
                campaign.close()
                break
            codes[code] += 1
            what = f"{board.what} (call {number}, {action})"
            blamed = campaign.count(BLAMED)
            tally.expect(campaign, code == lab.undisturbed(campaign)[0], f"{what}: exit code {code}")
            tally.expect(campaign, not blamed, f"{what}: {blamed} attempts were blamed")
            tally.judge(campaign)
    tally.remarks.append("exit codes " + ", ".join(f"{code}: {count}" for code, count in sorted(codes.items())))


def enter_private_mounts():
    """Makes later mounts private to this process and its children."""
    library = ctypes.CDLL(None, use_errno=True)
    user, group = os.getuid(), os.getgid()
    if library.unshare(CLONE_NEWNS) != 0:
        if library.unshare(CLONE_NEWNS | CLONE_NEWUSER) != 0:
            raise OSError(ctypes.get_errno(), "the disk-full case needs root or user namespaces (unshare)")
        for file, text in (("setgroups", "deny"), ("uid_map", f"0 {user} 1"), ("gid_map", f"0 {group} 1")):
            with open(f"/proc/self/{file}", "w") as f:
                f.write(text)
    subprocess.run(["mount", "--make-rprivate", "/"], check=True)


def full_disks(lab, tally, chance, times, folders):
    """Fills each file system in turn from some moment on, then makes room."""
    enter_private_mounts()
    outcomes = collections.Counter()
    for _ in range(times):
        for name in folders:
            campaign = Campaign(lab, checkpoint=0.001, steps=10, step_ms=1)
            place = campaign.path(*filter(None, [name]))
            os.makedirs(place)
            subprocess.run(["mount", "-t", "tmpfs", "-o", "size=8m", "none", place], check=True)
            room = chance.randint(0, 1_600_000 if not name else 9_000)
            ballast = os.path.join(place, "ballast.tmp")  # a name that a spool ignores
            fill(ballast, place, room)
            owner = campaign.start()
            ended = ends_within(owner, chance.uniform(0.5, 3))
            os.unlink(ballast)
            owner.wait(PATIENCE)
            outcomes[f"exit code {owner.returncode}" if ended else "paused until there was room"] += 1
            campaign.settle()
            tally.expect(campaign, owner.returncode in (0, 1, 3), f"{name or 'everything'} full: {owner.returncode}")
            given_up = campaign.count("SELECT count(*) FROM realisation WHERE state = 'quarantined'")
            tally.expect(campaign, not given_up, f"{name or 'everything'} full: {given_up} seeds were given up")
            campaign.unmount = place
            tally.judge(campaign)
    tally.count(outcomes)


def fill(ballast, place, room):
    with open(ballast, "wb") as f:
        about = os.statvfs(place)
        f.write(bytes(max(0, about.f_bavail * about.f_frsize - room)))
