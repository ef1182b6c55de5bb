"""Other processes at a campaign: a second owner, and readers."""
import os
import signal
import threading
import time

from campaign_folder import comes_true
from drill.board import Board
from drill.campaign import Campaign, alive
from drill.stops import busy_workers


def second_owners(lab, tally, chance, times):
    """Starts a second owner at a random moment of a run: exit code 5, and no call that changes a file."""
    while tally.tried < times:
        campaign = Campaign(lab, steps=10, step_ms=60)
        owner = campaign.start()
        busy_workers(campaign, owner)
        while tally.tried < times and owner.poll() is None:
            board = Board(campaign.folder)
            time.sleep(chance.uniform(0, 0.1))
            code = campaign.run(board.environment(lab.shim, role="owner", path=".peclet"))
            if owner.poll() is not None:
                break
            tally.tried += 1
            tally.expect(campaign, code == 5, f"the second owner ended with exit code {code}")
            tally.expect(campaign, board.calls == 0, f"the second owner changed files by {board.calls} calls")
        owner.wait()
        tally.judge(campaign, 0)


def readers(lab, tally, chance, loops, seeds):
    """Loops `peclet status` in `loops` readers beside the run, and stops one that holds its snapshot."""
    campaign = Campaign(lab, steps=10, step_ms=4)
    hold = campaign.environment["PECLET_FAKE_HOLD"] = campaign.place("hold")
    with open(hold, "w"):  # seeds wait until there are readers
        pass
    campaign.document["realisations"] = {"minimum": seeds, "maximum": seeds}
    campaign.write()
    owner = campaign.start()
    busy_workers(campaign, owner)
    stopped = stop_a_reader(campaign, tally)
    lock, answers, slowest = threading.Lock(), [], [0.0]

    def look():
        while owner.poll() is None:
            started = time.monotonic()
            done = campaign.say("status", "drill.json")
            with lock:
                answers.append(done.returncode)
                slowest[0] = max(slowest[0], time.monotonic() - started)
                if done.returncode:
                    tally.complain(campaign, f"status failed: {done.stderr.decode()}")

    started = time.monotonic()
    threads = [threading.Thread(target=look) for _ in range(loops)]
    for thread in threads:
        thread.start()
    os.remove(hold)
    code = owner.wait()
    seconds = time.monotonic() - started
    for thread in threads:
        thread.join()
    log = os.path.getsize(campaign.path("campaign.db-wal"))
    tally.expect(campaign, code == lab.undisturbed(campaign)[0], f"the run ended with exit code {code}")
    tally.expect(campaign, alive(stopped.pid), "the stopped reader has gone")
    os.kill(stopped.pid, signal.SIGCONT)
    tally.expect(campaign, stopped.wait(20) == 0, f"the stopped reader ended with exit code {stopped.returncode}")
    tally.remarks.append(
        f"{len(answers)} answers, the slowest after {slowest[0]:.1f} s; {2 * seeds} results in "
        f"{seconds:.1f} s; the write-ahead log grew to {log / 1e6:.1f} MB beside the stopped reader"
    )
    tally.judge(campaign, len(answers))


def stop_a_reader(campaign, tally):
    """Stops a `peclet status` half-way through the pages it reads."""
    command = [campaign.lab.peclet, "status", "drill.json"]
    count = Board(campaign.folder)
    campaign.start(count.environment(campaign.lab.shim, call="read", path="campaign.db"), command).wait()
    board = Board(campaign.folder)
    fault = {"call": "read", "path": "campaign.db", "action": "stop", "number": max(3, count.calls // 2)}
    reader = campaign.start(board.environment(campaign.lab.shim, **fault), command)
    comes_true(lambda: board.struck or reader.poll() is not None, nap=0.005)
    tally.expect(campaign, board.struck == 1, "no reader was stopped within its snapshot")
    return reader
