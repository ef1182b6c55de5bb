"""Campaigns that are changed while they run; the owner and the requesting verbs are killed."""
import collections
import contextlib
import os
import time

from drill.board import Board
from drill.campaign import FAKE, Campaign
from drill.kills import calls_of, kind_of

WISHES = [
    ["set", "drill.json", "--tolerance", "0.3"],
    ["set", "drill.json", "--tolerance", "0.05", "--maximum", "20"],
    ["set", "drill.json", "--point", "peclet=2", "--priority", "3"],
    ["cancel", "drill.json", "peclet=2"],
    ["cancel", "drill.json", "peclet=2", "--undo"],
    ["retry", "drill.json"],
]
# The state of the undisturbed campaign from its beginning.
LAST = [["set", "drill.json", "--tolerance", "0.08", "--maximum", "14"], ["cancel", "drill.json", "peclet=2", "--undo"]]


def changes_and_kills(lab, tally, chance, times):
    """Changes the campaign and kills at random; the end must be that of the last request."""
    asked = killed = 0
    while tally.tried < times:
        campaign = Campaign(lab, step_ms=20, checkpoint=0.005)
        for _ in range(6):
            owner = campaign.start()
            time.sleep(chance.uniform(0, 0.3))
            verb = campaign.start(command=[lab.peclet, *chance.choice(WISHES)])
            asked += 1
            for process in chance.sample([owner, verb], 2):
                time.sleep(chance.uniform(0, 0.8))
                if process is owner or chance.random() < 0.5:
                    killed += process.poll() is None
                    with contextlib.suppress(ProcessLookupError):
                        process.kill()
            owner.wait()
            verb.wait()
            campaign.settle()
        for wish in LAST if os.path.exists(campaign.path("campaign.db")) else LAST[:1]:
            code = campaign.start(command=[lab.peclet, *wish]).wait()
            tally.expect(campaign, code == 0, f"peclet {' '.join(wish)} ended with exit code {code}")
        blamed = campaign.count("SELECT total(blamed) FROM attempt")
        tally.expect(campaign, not blamed, f"{blamed:.0f} attempts are blamed for what was asked")
        tally.judge(campaign)
    tally.remarks.append(f"{asked} requests, {killed} kills of owners and verbs")


def edges_of_a_verb(lab, tally, chance, stride):
    """Reopens a finished campaign with a verb, killed before each call that changes a file; repeats it."""
    struck = collections.Counter()
    tighten = [lab.peclet, "set", "drill.json", "--tolerance", str(FAKE["target"]["relative_tolerance"])]
    for number in calls_of(stride, chance):
        campaign = Campaign(lab, dict(FAKE, target=dict(FAKE["target"], relative_tolerance=0.3)))
        campaign.run()
        board = Board(campaign.folder)
        disturbed = board.environment(lab.shim, role="owner", number=number, path="drill.json,.peclet/")
        campaign.start(disturbed, tighten).wait()
        if not board.struck:
            break  # the verb ended before
        struck[kind_of(board.what)] += 1
        code = campaign.start(command=tighten).wait()
        tally.expect(campaign, code == 0, f"peclet set ended with exit code {code}")
        campaign.document = dict(campaign.document, target=FAKE["target"])
        tally.judge(campaign)
    tally.count(struck)
