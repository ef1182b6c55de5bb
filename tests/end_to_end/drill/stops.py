"""Processes that are stopped and continued, and a wall clock that jumps."""
import contextlib
import glob
import os
import signal
import time

from campaign_folder import children, comes_true
from drill.board import Board
from drill.campaign import Campaign, alive

LEASE = 1.2
BEYOND = 2.5  # duration of a stop [s], longer than a lease and the owner's waits


def signal_to(process, number):
    with contextlib.suppress(ProcessLookupError):
        os.kill(process, number)


def nobody_is_blamed(tally, campaign):
    blamed = campaign.query("SELECT seed, outcome, message FROM attempt WHERE blamed")
    tally.expect(campaign, not blamed, f"blamed: {blamed}")


def busy_workers(campaign, owner):
    """Returns the workers once some have seeds."""
    found = []

    def are_busy():
        with contextlib.suppress(Exception):  # before the database exists
            running = [row[0] for row in campaign.query("SELECT process FROM attempt WHERE outcome = 'running'")]
            found.extend(process for process in children(owner.pid) if process in running)
        return found or owner.poll() is not None

    comes_true(are_busy)
    return found


def worker_stopped(lab, tally, chance, times):
    """Stops a worker. The owner must end it before the seed runs again, without a wait or blame."""
    for _ in range(times):
        campaign = Campaign(lab, lease=LEASE, steps=10, step_ms=30)
        owner = campaign.start()
        time.sleep(chance.uniform(0, 0.5))
        victim = chance.choice(busy_workers(campaign, owner))
        signal_to(victim, signal.SIGSTOP)
        gone = comes_true(lambda: not alive(victim) or owner.poll() is not None, 60, 0.02)
        tally.expect(campaign, gone, "a stopped worker outlived its lease")
        signal_to(victim, signal.SIGCONT)
        owner.wait()
        nobody_is_blamed(tally, campaign)
        tally.judge(campaign)


def late_workers(lab, tally, chance, times):
    """Lets a worker hang in a call while its owner dies and another owner runs the campaign; then continues
    it. A stopped process would not do: it gets SIGHUP when its owner dies."""
    for _ in range(times):
        campaign = Campaign(lab, checkpoint=0.001, steps=10, step_ms=1)
        board = Board(campaign.folder)
        owner = campaign.start(board.environment(lab.shim, role="worker", number=chance.randint(1, 120), action="wait"))
        board.wait(owner)
        owner.kill()
        owner.wait()
        campaign.acknowledge()
        if board.struck:
            successor = campaign.start()
            if chance.random() < 0.5:  # wakes it during the other run, or after it
                time.sleep(chance.uniform(0, 0.1))
            else:
                successor.wait()
            board.switch_off()
            successor.wait()
        nobody_is_blamed(tally, campaign)
        tally.judge(campaign, 1 if board.struck else 0)


def owner_stopped(lab, tally, chance, times):
    """Stops the owner beyond its lease, before a call or anywhere, alone or with its workers."""
    for number in range(times):
        campaign = Campaign(lab, lease=LEASE, steps=10, step_ms=40)
        board = Board(campaign.folder)
        if number % 2 == 0:
            call, path = chance.choice((("any", ".peclet/,socket"), ("write", "campaign.db"), ("read", "campaign.db")))
            fault = {"call": call, "path": path, "number": chance.randint(20, 60), "action": "stop"}
            owner = campaign.start(board.environment(lab.shim, role="owner", **fault))
            board.wait(owner)
        else:
            owner = campaign.start()
            busy_workers(campaign, owner)
            time.sleep(chance.uniform(0, 0.6))
            signal_to(owner.pid, signal.SIGSTOP)
        frozen = children(owner.pid) if number % 4 >= 2 else []
        for worker in frozen:
            signal_to(worker, signal.SIGSTOP)
        time.sleep(BEYOND)
        # Continues the owner first, which then finds its workers silent.
        signal_to(owner.pid, signal.SIGCONT)
        time.sleep(0.05)
        for worker in frozen:
            signal_to(worker, signal.SIGCONT)
        owner.wait()
        nobody_is_blamed(tally, campaign)
        tally.judge(campaign)


def clock_jumps(lab, tally, chance, times):
    """Makes the wall clock of owner and workers jump by a day both ways; the monotonic clock is unchanged."""
    days = 0.0
    libraries = glob.glob("/usr/lib/*/faketime/libfaketime.so.1")
    if not libraries:
        raise RuntimeError("the clock cannot be moved without Debian's package libfaketime")
    for _ in range(times):
        campaign = Campaign(lab, lease=5, checkpoint=0.02, steps=10, step_ms=10)
        clock = os.path.join(campaign.folder, "clock")

        def set_clock(offset):
            with open(clock + ".new", "w") as f:
                f.write(offset)
            os.rename(clock + ".new", clock)

        now = "+0"
        set_clock(now)
        owner = campaign.start(
            {
                "LD_PRELOAD": libraries[0],
                "FAKETIME_TIMESTAMP_FILE": clock,
                "FAKETIME_NO_CACHE": "1",
                "FAKETIME_DONT_FAKE_MONOTONIC": "1",
                "NO_FAKE_STAT": "1",
            }
        )
        while owner.poll() is None:
            time.sleep(chance.uniform(0.02, 0.15))
            now = chance.choice([offset for offset in ("+1d", "-1d", "+0") if offset != now])
            set_clock(now)
        nobody_is_blamed(tally, campaign)
        span = campaign.count("SELECT max(julianday(started_at)) - min(julianday(started_at)) FROM attempt")
        tally.expect(campaign, span > 0.9, f"the clock has not jumped: the attempts began within {span} days")
        days = max(days, span)
        tally.judge(campaign)
    tally.remarks.append(f"attempts of one campaign began up to {days:.1f} days apart")
