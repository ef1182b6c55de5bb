"""Calls that fail under SQLite."""
import collections

from drill.board import Board
from drill.campaign import FAKE, Campaign

# The shortest campaign there is: every one of its calls can fail in turn.
SHORT = dict(FAKE, sweep=[{"set": "/peclet", "values": [1]}], realisations={"minimum": 2, "maximum": 2})


def failing_calls(lab, tally, chance, call, action, path, stride=1, role="owner", document=SHORT):
    """The nth call fails, for all n: the run ends with exit code 1 and a message, or goes on. What cannot be read may be
    called damaged (6), as SQLite does."""
    allowed = {1, 6} if call == "read" else {1}
    calls, number, codes = None, 1 if stride == 1 else chance.randint(1, stride), collections.Counter()
    while calls is None or number <= calls:
        campaign = Campaign(lab, document, workers=1)
        board = Board(campaign.folder)
        code = campaign.run(board.environment(lab.shim, role=role, call=call, path=path, number=number, action=action))
        if not board.struck:
            calls = number
            campaign.close()
            break
        codes[code] += 1
        log = campaign.log().splitlines()
        tally.expect(campaign, code in allowed | {lab.undisturbed(campaign)[0]}, f"{board.what} (call {number}): exit code {code}")
        tally.expect(campaign, code not in allowed or any(line.startswith("peclet: ") and len(line) > 20 for line in log),
                     f"{board.what} (call {number}): no message")
        tally.judge(campaign)
        number += stride
    tally.remarks.append("exit codes " + ", ".join(f"{code}: {count}" for code, count in sorted(codes.items())))
