"""The campaign's folder: two owners, copies, things deleted under a run."""
import os
import signal

from .night import workers_of


def running(night, results=3, milliseconds=100, command="peclet run night.json --workers 2"):
    """Starts a campaign and waits for its first results; it does not end before the case calls lets_go()."""
    night.slow(milliseconds)
    night.holds()
    night.write()
    run = night.starts(command)
    night.wait_for_results(results)
    night.remembers()
    return run


def second_owner(night):
    """Started a second time in another terminal"""
    run = running(night)
    night.types(
        "peclet run night.json", 5, [f"process {run.pid} owns this campaign", "peclet status", f"kill {run.pid}"]
    )
    night.follows(r"kill \d+")
    night.waits(run, 75, ["workers checkpoint and stop"])
    night.lets_go()
    night.remembers()
    night.ends()
    night.answers_as_undisturbed()


def lock_deleted(night):
    """campaign.lock deleted because it is in the way, and a second owner started"""
    run = running(night)
    night.types("rm night.peclet/campaign.lock && peclet run night.json", 5, [f"process {run.pid} owns this campaign"])
    night.types("peclet status night.peclet", 0, [f"process {run.pid} runs the campaign"])
    night.lets_go()
    night.waits(run)
    night.remembers()
    night.lost_nothing()
    night.answers_as_undisturbed()


def copied(night):
    """The folder copied with cp while it runs, and the copy run, too"""
    run = running(night)
    night.lets_go()
    night.types("cp -r night.peclet copy.peclet && cp night.json copy.json && peclet run copy.json --quiet", (0, 6))
    if "damaged" in night.said:  # a copy of files being written may be torn; its backup must help
        night.follows(r"peclet restore [^`]*")
        night.types("peclet run copy.json --quiet")
    night.waits(run)
    night.remembers()
    night.lost_nothing("copy.peclet")
    night.answers_as_undisturbed()


def folder_deleted(night):
    """The whole folder deleted while it runs"""
    run = running(night)
    night.types("rm -rf night.peclet || rm -rf night.peclet")
    night.waits(run, 6, ["was deleted while the campaign ran", "were saved in"])
    night.lets_go()
    night.follows(r"peclet restore [^`]*", 0, ["restored from"])
    night.follows(r"peclet run [^`\n]*", 0, ["2 converged"])
    night.lost_nothing()
    night.answers_as_undisturbed()


def folder_moved(night):
    """The folder moved while it runs"""
    run = running(night)
    night.types("mv night.peclet moved.peclet")
    night.waits(run, 6, ["was moved to", "moved.peclet", "--directory"])
    night.lets_go()
    night.types("peclet run night.json --quiet --directory moved.peclet", 0, ["2 converged"])
    night.lost_nothing("moved.peclet")


def folders_below_deleted(night):
    """spool, logs and checkpoints deleted while it runs"""
    run = running(night)
    night.types("rm -rf night.peclet/{spool,logs,checkpoints} || rm -rf night.peclet/{spool,logs,checkpoints}")
    night.wait_for_answer(run, "made anew")
    night.lets_go()
    night.waits(run, 0, ["were deleted", "made anew: spool/", "2 converged"])
    night.lost_nothing()
    night.answers_as_undisturbed()


def spool_edited(night):
    """A result in the spool edited by hand"""
    run = running(night)
    os.kill(run.pid, signal.SIGKILL)
    run.wait()
    night.wait_for("the end of its workers", lambda: not workers_of(night))
    night.remembers()
    night.remarks(
        "The run is killed. In the spool lies a result that is not booked yet. A number in it is edited by hand, and "
        "a bracket goes missing."
    )
    with open(night.path("night.peclet", "spool", "0123456789abcdef-000000-99.json"), "w") as f:
        f.write('{"schema_version": 1, "point": "corrected"')
    night.lets_go()
    night.slow(20)
    night.types("peclet run night.json --workers 2", 0, ["is not taken", "it is kept in", "2 converged"])
    night.lost_nothing()
    night.answers_as_undisturbed()


def checkpoint_deleted(night):
    """Checkpoints deleted between two runs"""
    night.slow(1000)
    night.write()
    run = night.starts("peclet run night.json --workers 2 --checkpoint 0.1")
    night.wait_for("checkpoints", lambda: len(os.listdir(night.path("night.peclet", "checkpoints"))) >= 2)
    night.stops(run)
    night.waits(run, 75)
    night.slow(20)
    night.types("rm night.peclet/checkpoints/* && peclet run night.json --quiet", 0, ["2 converged"])
    night.answers_as_undisturbed()


CASES = [
    second_owner,
    lock_deleted,
    copied,
    folder_deleted,
    folder_moved,
    folders_below_deleted,
    spool_edited,
    checkpoint_deleted,
]
SLOW = [copied, folder_moved]
