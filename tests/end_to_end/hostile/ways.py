"""The ways, by folder: a name, the path, the object, the expected outcome and message."""
import dataclasses
import typing

from . import things

GOES_ON = "goes on"  # to equal bytes at once
REFUSED = "refused"  # with one line; to equal bytes once the object is removed


@dataclasses.dataclass
class Way:
    path: str  # in the campaign's folder; {point} and {seed} are those that run next
    put: typing.Callable
    outcome: str
    says: str  # a part of the line; "" for no message
    quick: bool = False  # also in the short form
    real: bool = False  # with peclet-engine, which meets the object
    code: int = 2  # exit code of a refusal
    humble: bool = False  # run by an ordinary user, because root may read everything
    name: str = ""

    def title(self):
        return self.name or f"{self.path}: {self.put.__name__.replace('_', ' ')}"


RESULT = "spool/{point}-{seed:06}-77.json"
CHECKPOINT = "checkpoints/{point}-{seed:06}.checkpoint"
ASIDE = "entries that are not regular files"
ODD_NAME = "a\nb\x1b[2J\udcff.json"


def ways_with(path, puts, outcome, says, quick=(), **more):
    return [Way(path, put, outcome, says, quick=put in quick, **more) for put in puts]


NO_FILES = [
    things.link,
    things.link_to_folder,
    things.loop,
    things.dangling,
    things.fifo,
    things.folder,
    things.unix_socket,
    things.device,
]

SPOOL = [
    *ways_with(RESULT, NO_FILES, GOES_ON, ASIDE, quick=[things.loop, things.fifo]),
    *ways_with(RESULT, [things.sparse, things.rubbish, things.empty], GOES_ON, "is not taken", quick=[things.sparse]),
    Way(
        "spool/" + ODD_NAME,
        things.rubbish,
        GOES_ON,
        "is not taken",
        quick=True,
        name="spool: a name with a newline, an escape and no UTF-8",
    ),
    Way("spool/" + ODD_NAME, things.link, GOES_ON, ASIDE, name="spool: a link of such a name"),
    Way(
        "spool/" + "n" * 250 + ".json", things.rubbish, GOES_ON, "is not taken", name="spool: the longest name there is"
    ),
    Way("spool", things.crowd_of_links(100_000), GOES_ON, ASIDE, quick=True, name="spool: 100000 links"),
    Way("spool", things.crowd(100_000), GOES_ON, "more files in", quick=True, name="spool: 100000 files of rubbish"),
    *ways_with(
        "spool",
        [things.linked_folder, things.loop, things.regular, things.fifo, things.foreign],
        REFUSED,
        "spool: ",
        quick=[things.linked_folder, things.foreign],
    ),
    *ways_with("spool/rejected", [things.linked_folder, things.regular], REFUSED, "rejected: "),
]
REQUESTS = [
    *ways_with("requests/0.json", NO_FILES, GOES_ON, ASIDE, quick=[things.fifo, things.loop]),
    *ways_with(
        "requests/0.json",
        [things.sparse, things.rubbish, things.empty],
        GOES_ON,
        "is not a valid request",
        quick=[things.sparse],
    ),
    Way(
        "requests/0.json",
        things.text('{"version": 1, "verb": "prioritise", "points": ["peclet=1"], "priority": 1e300}'),
        GOES_ON,
        "must be an integer >= -2147483648",
        quick=True,
        name="requests: a priority of 1e300",
    ),
    Way(
        "requests/0.json",
        things.text("[" * 500_000),
        GOES_ON,
        "is not a valid request",
        name="requests: half a million brackets",
    ),
    Way(
        "requests/0.json",
        things.text('{"version": 1, "verb": "take-over", "file": "/dev/zero", "sha256": ""}'),
        GOES_ON,
        "/dev/zero",
        name="requests: to take /dev/zero over",
    ),
    Way(
        "requests/" + ODD_NAME,
        things.rubbish,
        GOES_ON,
        "is not a valid request",
        name="requests: a name with a newline, an escape and no UTF-8",
    ),
    Way("requests", things.crowd(2_000), GOES_ON, "is not a valid request", name="requests: 2000 files of rubbish"),
    Way("requests", things.linked_folder, REFUSED, "requests: is a link"),
]
CHECKPOINTS = [
    *ways_with(CHECKPOINT, NO_FILES, GOES_ON, ASIDE, quick=[things.link]),
    *ways_with(CHECKPOINT, [things.sparse, things.rubbish, things.empty], GOES_ON, "", real=True),
    Way(CHECKPOINT + ".rejected", things.folder, GOES_ON, ASIDE),
    Way("checkpoints", things.linked_folder, REFUSED, "checkpoints: is a link"),
]
LOGS = [
    *ways_with("logs/peclet.log", NO_FILES, GOES_ON, ASIDE, quick=[things.link]),
    *ways_with("logs/worker-0.log", [things.link, things.fifo, things.folder], GOES_ON, ASIDE),
    Way("logs/peclet.log.1", things.link, GOES_ON, ASIDE),
    *ways_with("logs", [things.linked_folder, things.regular], REFUSED, "logs: "),
]
OTHERS = [
    *ways_with("failures/x.state", [things.link, things.folder], GOES_ON, ASIDE),
    Way("failures", things.linked_folder, REFUSED, "failures: is a link"),
    *ways_with("backup/backup.db", NO_FILES, REFUSED, "backup.db: is ", quick=[things.fifo, things.link]),
    *ways_with("backup/backup.db", [things.rubbish, things.truncated], GOES_ON, ""),
    Way("backup/backup.previous.db", things.folder, GOES_ON, ASIDE),
    *ways_with("backup", [things.linked_folder, things.regular], REFUSED, "backup: "),
    Way("aside", things.linked_folder, REFUSED, "aside: is a link"),
]
LOCK = ways_with("campaign.lock", NO_FILES, REFUSED, "campaign.lock: is ", quick=[things.link, things.fifo])
DATABASE = [
    *ways_with(
        "campaign.db",
        [things.link, things.loop, things.fifo, things.folder, things.unix_socket, things.device],
        REFUSED,
        "campaign.db: is ",
        quick=[things.link],
    ),
    *ways_with(
        "campaign.db",
        [things.rubbish, things.truncated, things.sparse, things.empty],
        REFUSED,
        "campaign.db",
        code=6,
        quick=[things.sparse],
    ),
    *ways_with(
        "campaign.db-wal",
        [things.link, things.fifo, things.folder, things.device],
        REFUSED,
        "campaign.db-wal: is ",
        quick=[things.fifo],
    ),
    *ways_with("campaign.db-shm", [things.link, things.fifo, things.folder], REFUSED, "campaign.db-shm: is "),
    *ways_with("campaign.db-journal", [things.link, things.fifo], REFUSED, "campaign.db-journal: is "),
]
CLOSED = [
    Way(RESULT, things.closed, GOES_ON, "is not taken", humble=True, quick=True),
    Way("requests/0.json", things.closed, GOES_ON, "is not a valid request", humble=True),
    Way(CHECKPOINT, things.closed, GOES_ON, "", humble=True, real=True),
    Way("logs/peclet.log", things.closed, GOES_ON, "", humble=True),
    *ways_with(
        "", [things.closed], REFUSED, "Permission denied", humble=True, code=1, name="the campaign's folder: closed"
    ),
    *[
        Way(path, things.closed, REFUSED, path, humble=True, code=1)
        for path in ("spool", "campaign.lock", "campaign.db", "backup/backup.db")
    ],
]
WAYS = CLOSED + SPOOL + REQUESTS + CHECKPOINTS + LOGS + OTHERS + LOCK + DATABASE
