"""The database: deleted, cut, replaced, of another version."""
import os
import shutil
import signal
import sqlite3

from .folders import running
from .night import workers_of


def killed(night):
    """Runs a campaign, kills its owner after some results, and waits for the end of its workers."""
    night.has_begun(0.6)
    before = len(night.results())
    run = running(night, before + 3, 300)
    os.killpg(run.pid, signal.SIGKILL)
    run.wait()
    night.wait_for("the end of its workers", lambda: not workers_of(night))
    night.lets_go()
    night.slow(20)
    return before


def deleted(night):
    """campaign.db deleted"""
    night.has_run()
    night.types("rm night.peclet/campaign.db && peclet run night.json", 6, ["is gone", "backups"])
    night.follows(r"peclet restore [^`]*", 0, ["restored from", "with 16 results"])
    night.follows(r"peclet run [^`\n]*", 0, ["2 converged"])
    night.lost_nothing()


def deleted_while_it_runs(night):
    """campaign.db deleted while it runs"""
    run = running(night, 3, 300)
    night.types("rm night.peclet/campaign.db")
    night.waits(run, 6, ["was deleted while the campaign ran", "were saved in"])
    night.lets_go()
    night.follows(r"peclet restore [^`]*", 0, ["restored from"])
    night.ends()
    night.answers_as_undisturbed()


def cut(night):
    """campaign.db cut short"""
    night.has_run()
    night.types(
        "truncate -s 20000 night.peclet/campaign.db && peclet status night.json", 6, ["is damaged", "peclet restore"]
    )
    night.types("peclet run night.json", 6, ["damaged", "peclet restore"])
    night.follows(r"peclet restore [^`]*", 0, ["restored from", "with 16 results", "is kept in"])
    night.ends()


def older_copy(night):
    """campaign.db overwritten by last week's copy"""
    night.has_begun(0.8)
    shutil.copy(night.path("night.peclet", "campaign.db"), night.path("last-week.db"))
    night.slow(20)
    night.types("peclet run night.json --quiet > table")
    night.remembers()
    night.types(
        "cp last-week.db night.peclet/campaign.db && peclet run night.json",
        6,
        ["is older than its own backup", "16", "Put the newer one back with"],
    )
    night.follows(r"peclet restore [^`]*", 0, ["with 16 results", "is kept in"])
    night.ends()


def log_deleted(night):
    """campaign.db-wal deleted after a crash, to tidy up"""
    before = killed(night)
    night.types(
        "rm night.peclet/campaign.db-wal night.peclet/campaign.db-shm && peclet run night.json --quiet",
        0,
        ["2 converged"],
    )
    night.remarks(
        f"What had been committed since the log was last copied into the database went with it ({before} results "
        "were older); these seeds ran again and gave the same results."
    )
    night.answers_as_undisturbed()


def copied_without_log(night):
    """campaign.db copied back by cp without its -wal"""
    killed(night)
    night.remembers()
    night.types("cp night.peclet/campaign.db usb.db && peclet run night.json --quiet", 0, ["2 converged"])
    night.lost_nothing()
    night.types("peclet restore usb.db night.json", 2, ["sound and as new as the backup", "--force"])
    night.lost_nothing()


def restored_over_newer(night):
    """An old backup restored over a newer database"""
    night.has_begun(0.8)
    night.types("peclet backup night.json usb")
    night.slow(20)
    night.types("peclet run night.json --quiet > table")
    night.remembers()
    night.types("peclet restore usb night.json", 2, ["16 results", "sound and as new as the backup", "--force"])
    night.lost_nothing()
    night.types("peclet restore usb night.json --force", 0, ["is kept in", "has more in it"])
    night.follows(r"peclet run [^`\n]*", 0, ["2 converged"])
    night.lost_nothing()


def another_program(night):
    """A database of another peclet"""
    night.has_run()
    database = sqlite3.connect(night.path("night.peclet", "campaign.db"))
    database.execute("PRAGMA user_version = 99")
    database.close()
    night.remarks("Here the database says that its tables are of version 99.")
    night.types("peclet run night.json", 2, ["written by another peclet", "version 99", "use the peclet that wrote it"])
    night.types("peclet status night.json", 2, ["written by another peclet"])
    night.lost_nothing()


CASES = [
    deleted,
    deleted_while_it_runs,
    cut,
    older_copy,
    log_deleted,
    copied_without_log,
    restored_over_newer,
    another_program,
]
SLOW = [deleted_while_it_runs, restored_over_newer, log_deleted]
