"""Kills and power cuts at random moments, and before each call that changes a file or sends a frame."""
import collections
import contextlib
import itertools
import os
import re
import signal
import time

from campaign_folder import children
from drill.board import Board
from drill.campaign import FAKE, Campaign
from drill.power import acknowledged_spool, cut, read_journal


def strike(process, whom):
    """Kills the owner, one worker, or the owner and all workers. Returns the number of processes killed."""
    workers = children(process.pid)
    victims = {"owner": [process.pid], "worker": workers[:1], "both": [process.pid, *workers]}[whom]
    for victim in victims:
        with contextlib.suppress(ProcessLookupError):
            os.kill(victim, signal.SIGKILL)
    return len(victims)


def seconds_alone(lab, document, **settings):
    """Returns the duration of such a campaign, at most 2.5 s, for random moments within it."""
    campaign = Campaign(lab, document, **settings)
    started = time.monotonic()
    campaign.run()
    seconds = time.monotonic() - started
    campaign.close()
    return min(seconds, 2.5)


def random_kills(lab, tally, chance, kills, document, per_campaign, **settings):
    """Kills at random moments, up to `per_campaign` times before a campaign is run to its end."""
    struck = collections.Counter()
    whole = seconds_alone(lab, document, **settings)
    while sum(struck.values()) < kills:
        campaign = Campaign(lab, document, **settings)
        before = sum(struck.values())
        for _ in range(per_campaign):
            process = campaign.start()
            time.sleep(chance.uniform(0, whole))
            whom = chance.choice(("owner", "worker", "both"))
            if process.poll() is None and strike(process, whom):
                struck[whom] += 1
            if whom == "worker":  # the owner replaces it, and is killed later
                time.sleep(chance.uniform(0, whole / 2))
                if process.poll() is None:
                    process.kill()
                    struck["owner"] += 1
            process.wait()
            campaign.acknowledge()
        blamed = campaign.count("SELECT total(blamed) FROM attempt")
        tally.expect(campaign, not blamed, f"{blamed:.0f} attempts are blamed for kills")
        tally.judge(campaign, sum(struck.values()) - before)
    tally.count(struck, "of ")


def edges(lab, tally, chance, role, stride, document=FAKE, action="kill"):
    """Kills before every call of the owner or of its workers that changes a file or sends a frame."""
    struck = collections.Counter()
    for number in calls_of(stride, chance):
        campaign = Campaign(lab, document, workers=1, checkpoint=0.001)
        board = Board(campaign.folder)
        campaign.run(board.environment(lab.shim, role=role, number=number, action=action))
        if not board.struck:
            break  # the campaign ended before
        struck[kind_of(board.what)] += 1
        tally.judge(campaign)
    tally.count(struck)


def calls_of(stride, chance):
    """Returns the numbers of every `stride`th call, from a random one of the first `stride`."""
    return itertools.count(1 if stride == 1 else chance.randint(1, stride), stride)


def kind_of(what):
    """Returns the kind of call and of file, without the parts that differ between seeds and processes."""
    call, path = what.split(" ", 1)
    if path == "socket":
        return "send"
    unfinished = path.endswith(".tmp")
    path = path.split(".peclet/")[1] if ".peclet/" in path else "campaign file"
    file = re.sub(r"campaign\.db", "database", path).split("/")[0]
    return f"{call} {file}" if not unfinished else f"{call} {file} (unfinished)"


def power_cuts(lab, tally, chance, cuts, document=FAKE):
    """Ends everything before a random call, and drops a part of the data that was not synchronised."""
    at_stake = collections.Counter()
    calls = 650 if document is FAKE else 1500
    while tally.tried < cuts:
        campaign = Campaign(lab, document, checkpoint=0.001 if document is FAKE else 0.1)
        for round_ in range(2):  # the second cut hits the remains of the first
            board = Board(campaign.folder)
            journal = os.path.join(campaign.folder, f"journal-{round_}")
            campaign.run(board.environment(lab.shim, number=chance.randint(1, calls), action="cut", journal=journal))
            campaign.settle()
            if board.struck:
                at_stake.update(take_back(campaign, journal, chance))
                tally.tried += 1
            else:
                calls = board.calls
        tally.judge(campaign, 0)
    tally.remarks.append(f"{at_stake['contents']} unsynchronised writes and {at_stake['names']} names at stake")


def take_back(campaign, journal, chance):
    """Counts results as safe once their spool file and its name were synchronised."""
    states = campaign.results()
    durable = acknowledged_spool(read_journal(journal))
    contents, names = cut(campaign, journal, chance)
    last = campaign.last_attempt()
    for key in durable:
        campaign.safe.setdefault(key, (states.get(key), last))
    return {"contents": contents, "names": names}
