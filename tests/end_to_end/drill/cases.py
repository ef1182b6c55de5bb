"""The cases of the drill in the order of the table: a name, and the full and the quick form."""
import dataclasses
import typing

from drill import company, kills, messages, requests, stops, storage
from drill.campaign import FAKE, REAL


@dataclasses.dataclass
class Case:
    name: str
    full: typing.Callable
    quick: typing.Callable

    def run(self, lab, tally, chance, quick):
        (self.quick if quick else self.full)(lab, tally, chance)


def case(name, function, full, quick):
    """Returns a case. `full` has the arguments of the full form, `quick` the changes of the quick form."""
    quick = full | quick
    return Case(name, lambda *about: function(*about, **full), lambda *about: function(*about, **quick))


ALLOCATIONS = {"call": "allocation", "action": "fail", "path": ""}


def every_allocation():
    """Returns the case of all ten thousand allocations, which takes an hour; the full form has 5 %."""
    return case("database: every allocation fails in turn", storage.failing_calls, ALLOCATIONS, {})


# Strides of calls in the quick form.
STRIDES = {"write": 40, "sync": 5, "truncate": 1, "read": 9}
KILLS = {"kills": 500, "document": FAKE, "per_campaign": 5, "step_ms": 1, "checkpoint": 0.005}
REAL_KILLS = {"kills": 40, "document": REAL, "per_campaign": 10, "checkpoint": 0.02}
FILES = {"calls": ["create", "sync", "rename"], "actions": ["enospc", "edquot", "eio"], "path": "/files/"}
FOLDERS = ["", "spool", "checkpoints", "logs"]
FAILURES = [("write", "eio"), ("write", "enospc"), ("write", "edquot"), ("sync", "eio"), ("sync", "enospc")]
FAILURES += [("truncate", "eio"), ("read", "eio")]

CASES = [
    case("kill at random moments", kills.random_kills, KILLS, {"kills": 20}),
    case("kill at random moments, real engine", kills.random_kills, REAL_KILLS, {"kills": 3, "per_campaign": 3}),
    case("kill before each call of the owner", kills.edges, {"role": "owner", "stride": 1}, {"stride": 40}),
    case("kill before each call of a worker", kills.edges, {"role": "worker", "stride": 1}, {"stride": 20}),
    case("power cut before a random call", kills.power_cuts, {"cuts": 400}, {"cuts": 10}),
    case("power cut, real engine", kills.power_cuts, {"cuts": 20, "document": REAL}, {"cuts": 1}),
    case("worker stopped beyond its lease", stops.worker_stopped, {"times": 20}, {"times": 1}),
    case("worker wakes up under another owner", stops.late_workers, {"times": 100}, {"times": 4}),
    case("owner stopped beyond the lease", stops.owner_stopped, {"times": 24}, {"times": 1}),
    case("wall clock jumps by a day", stops.clock_jumps, {"times": 20}, {"times": 1}),
    *(
        case(name, messages.engine_faults, {"times": 30, "faults": faults}, {"times": 1})
        for name, faults in (
            ("frames repeated, early, late, torn, oversize", messages.FRAMES),
            ("engine hangs, crashes or lies", messages.ENGINES),
        )
    ),
    case("engine crashes at each step", messages.crash_at_each_step, {"steps": range(10)}, {"steps": [3]}),
    case("engine gives another answer", messages.other_answer, {"times": 20}, {"times": 1}),
    case("rubbish in the spool", messages.spool_files, {"times": 25}, {"times": 1}),
    *(
        case(
            f"database: {call} fails with {action.upper()}",
            storage.failing_calls,
            {"call": call, "action": action, "path": "campaign.db"},
            {"stride": STRIDES[call]},
        )
        for call, action in FAILURES
    ),
    case("database: allocation fails", storage.failing_calls, ALLOCATIONS | {"stride": 20}, {"stride": 2000}),
    case(
        "owner cannot write or synchronise files of realisations",
        storage.passing_failures,
        FILES,
        {"calls": ["sync"], "stride": 7},
    ),
    case("changed while owner and verbs are killed", requests.changes_and_kills, {"times": 40}, {"times": 2}),
    case("kill before each call of a verb", requests.edges_of_a_verb, {"stride": 1}, {"stride": 12}),
    case("second owner", company.second_owners, {"times": 50}, {"times": 3}),
    case("64 readers and a stopped one", company.readers, {"loops": 64, "seeds": 200}, {"seeds": 20}),
    case("each file system full in turn", storage.full_disks, {"times": 10, "folders": FOLDERS}, {"times": 1}),
]
