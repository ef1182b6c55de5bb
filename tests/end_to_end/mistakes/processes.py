"""Ctrl-C, kill, closed laptops and lost connections."""
import os
import signal
import time

from .folders import running
from .night import workers_of


def interrupted_twice(night):
    """Ctrl-C, and again because it takes a second"""
    night.environment.update(
        PECLET_FAKE_FAULTS="hang:7", PECLET_FAKE_FAULT_STEP="0"
    )  # the engine ignores the first signal
    run = running(night)
    night.wait_for("a seed that hangs", lambda: night.query("SELECT 1 FROM attempt WHERE seed = 7"))
    night.remembers()
    os.killpg(run.pid, signal.SIGINT)
    night.wait_for_answer(run, "a second signal")  # two signals at once may merge
    os.killpg(run.pid, signal.SIGINT)
    night.waits(run, 75, ["a second signal stops at once", "`peclet run night.json` goes on"])
    night.lost_nothing()
    del night.environment["PECLET_FAKE_FAULTS"]
    night.lets_go()
    night.slow(20)
    night.ends()
    night.answers_as_undisturbed()


def owner_killed(night):
    """kill -9 of the owner"""
    run = running(night)
    os.kill(run.pid, signal.SIGKILL)
    run.wait()
    night.remarks("The run is killed.")
    night.wait_for("the end of its workers", lambda: not workers_of(night))
    night.lets_go()
    night.types("peclet status night.json", 0, ["no process runs the campaign now", "peclet run"])
    night.slow(20)
    night.types("peclet run night.json", 0, ["an earlier run left unfinished are queued again", "2 converged"])
    night.lost_nothing()
    night.answers_as_undisturbed()


def worker_killed(night):
    """kill -9 of a worker"""
    run = running(night)
    os.kill(workers_of(night)[0], signal.SIGKILL)
    night.lets_go()
    night.waits(run, 0, ["2 converged"], ["lost"])
    night.lost_nothing()
    night.answers_as_undisturbed()


def laptop_closed(night):
    """The laptop closed for a while: everything stands still"""
    night.slow(100)
    night.write()
    run = night.starts("peclet run night.json --workers 2 --lease 1")
    night.wait_for_results(3)
    night.remembers()
    frozen = [run.pid, *workers_of(night)]
    for process in frozen:
        os.kill(process, signal.SIGSTOP)
    night.remarks("All processes stand still for twice the time after which a worker counts as hung.")
    time.sleep(2.2)
    for process in frozen:
        os.kill(process, signal.SIGCONT)
    night.waits(run, 0, ["2 converged"], ["hung", "lost"])
    night.lost_nothing()
    night.answers_as_undisturbed()


def connection_lost(night):
    """The ssh connection lost (SIGHUP)"""
    run = running(night)
    os.killpg(run.pid, signal.SIGHUP)
    night.remarks("The terminal is gone; the shell sends its jobs SIGHUP.")
    night.waits(run, 75, ["workers checkpoint and stop", "`peclet run night.json` goes on"])
    night.lets_go()
    night.lost_nothing()
    night.slow(20)
    night.ends()


def connection_lost_under_nohup(night):
    """The same with nohup: it goes on"""
    run = running(night, milliseconds=40, command="nohup peclet run night.json --workers 2")
    os.killpg(run.pid, signal.SIGHUP)
    night.lets_go()
    night.waits(run, 0, ["2 converged"], ["stopp"])


def too_short(night):
    """A time limit that is shorter than a realisation"""
    night.slow(1500)
    night.write()
    for _ in range(2):
        night.types(
            "peclet run night.json --workers 2 --time-limit 0.5 --quiet",
            75,
            ["\n0 seeds ended", "`peclet run night.json` goes on"],
        )
    night.remarks("Each time the seeds go on from their checkpoints, so that they end after a few such runs.")
    night.types(
        "for i in 1 2 3 4; do peclet run night.json --workers 2 --time-limit 0.6 --quiet > table; done; "
        "peclet status night.json",
        0,
        [" seeds ended"],
        ["\n0 seeds ended"],
    )


CASES = [
    interrupted_twice,
    owner_killed,
    worker_killed,
    laptop_closed,
    connection_lost,
    connection_lost_under_nohup,
    too_short,
]
SLOW = [laptop_closed, too_short, worker_killed]
