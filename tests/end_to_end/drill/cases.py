"""The cases of the drill, in the table's order: a name, and what is done in the full and in the quick form."""
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


def every_allocation():
    """The full form takes one in twenty of some ten thousand allocations; this takes them all, which is an hour's
    work."""
    return case(
        "database: every allocation fails in turn",
        storage.failing_calls,
        {"call": "allocation", "action": "fail", "path": ""},
        {},
    )


def case(name, function, full, quick):
    """`full` and `quick` are the keyword arguments of the two forms."""
    return Case(name, lambda *about: function(*about, **full), lambda *about: function(*about, **quick))


# Of the quick form: every so many calls.
STRIDES = {"write": 40, "sync": 5, "truncate": 1, "read": 9}

CASES = [
    case(
        "kill at random moments",
        kills.random_kills,
        {"kills": 500, "document": FAKE, "per_campaign": 5, "step_ms": 1, "checkpoint": 0.005},
        {"kills": 20, "document": FAKE, "per_campaign": 5, "step_ms": 1, "checkpoint": 0.005},
    ),
    case(
        "kill at random moments, real engine",
        kills.random_kills,
        {"kills": 40, "document": REAL, "per_campaign": 10, "checkpoint": 0.02},
        {"kills": 3, "document": REAL, "per_campaign": 3, "checkpoint": 0.02},
    ),
    case(
        "kill before each call of the owner",
        kills.edges,
        {"role": "owner", "stride": 1},
        {"role": "owner", "stride": 40},
    ),
    case(
        "kill before each call of a worker",
        kills.edges,
        {"role": "worker", "stride": 1},
        {"role": "worker", "stride": 20},
    ),
    case("power cut before a random call", kills.power_cuts, {"cuts": 400}, {"cuts": 10}),
    case("power cut, real engine", kills.power_cuts, {"cuts": 20, "document": REAL}, {"cuts": 1, "document": REAL}),
    case("worker stopped beyond its lease", stops.worker_stopped, {"times": 20}, {"times": 1}),
    case("worker wakes up under another owner", stops.late_workers, {"times": 100}, {"times": 4}),
    case("owner stopped beyond the lease", stops.owner_stopped, {"times": 24}, {"times": 1}),
    case("wall clock jumps by a day", stops.clock_jumps, {"times": 20}, {"times": 1}),
    case(
        "frames repeated, early, late, torn, oversize",
        messages.engine_faults,
        {"times": 30, "faults": messages.FRAMES},
        {"times": 1, "faults": messages.FRAMES},
    ),
    case(
        "engine hangs, crashes or lies",
        messages.engine_faults,
        {"times": 30, "faults": messages.ENGINES},
        {"times": 1, "faults": messages.ENGINES},
    ),
    case("engine crashes at each step", messages.crash_at_each_step, {"steps": range(10)}, {"steps": [3]}),
    case("engine gives another answer", messages.other_answer, {"times": 20}, {"times": 1}),
    case("rubbish in the spool", messages.spool_files, {"times": 25}, {"times": 1}),
    *(
        case(
            f"database: {call} fails with {action.upper()}",
            storage.failing_calls,
            {"call": call, "action": action, "path": "campaign.db"},
            {"call": call, "action": action, "path": "campaign.db", "stride": STRIDES[call]},
        )
        for call, action in (
            ("write", "eio"),
            ("write", "enospc"),
            ("write", "edquot"),
            ("sync", "eio"),
            ("sync", "enospc"),
            ("truncate", "eio"),
            ("read", "eio"),
        )
    ),
    case(
        "database: allocation fails",
        storage.failing_calls,
        {"call": "allocation", "action": "fail", "path": "", "stride": 20},
        {"call": "allocation", "action": "fail", "path": "", "stride": 2000},
    ),
    case(
        "owner cannot write or synchronise files of realisations",
        storage.passing_failures,
        {"calls": ["create", "sync", "rename"], "actions": ["enospc", "edquot", "eio"], "path": "/files/"},
        {"calls": ["sync"], "actions": ["enospc", "edquot", "eio"], "path": "/files/", "stride": 7},
    ),
    case("changed while owner and verbs are killed", requests.changes_and_kills, {"times": 40}, {"times": 2}),
    case("kill before each call of a verb", requests.edges_of_a_verb, {"stride": 1}, {"stride": 12}),
    case("second owner", company.second_owners, {"times": 50}, {"times": 3}),
    case("64 readers and a stopped one", company.readers, {"loops": 64, "seeds": 200}, {"loops": 64, "seeds": 20}),
    case(
        "each file system full in turn",
        storage.full_disks,
        {"times": 10, "folders": ["", "spool", "checkpoints", "logs"]},
        {"times": 1, "folders": ["", "spool", "checkpoints", "logs"]},
    ),
]
