"""The cases of the drill, in the table's order: a name, and what is done in the full and in the quick form."""
import dataclasses
import typing

from drill import kills
from drill.campaign import FAKE, REAL


@dataclasses.dataclass
class Case:
    name: str
    full: typing.Callable
    quick: typing.Callable

    def run(self, lab, tally, chance, quick):
        (self.quick if quick else self.full)(lab, tally, chance)


def case(name, function, full, quick):
    """`full` and `quick` are the keyword arguments of the two forms."""
    return Case(name, lambda *about: function(*about, **full), lambda *about: function(*about, **quick))


CASES = [
    case("kill at random moments", kills.random_kills,
         {"kills": 500, "document": FAKE, "per_campaign": 5, "step_ms": 1, "checkpoint": 0.005},
         {"kills": 20, "document": FAKE, "per_campaign": 5, "step_ms": 1, "checkpoint": 0.005}),
    case("kill at random moments, real engine", kills.random_kills,
         {"kills": 40, "document": REAL, "per_campaign": 10, "checkpoint": 0.2},
         {"kills": 3, "document": REAL, "per_campaign": 3, "checkpoint": 0.2}),
    case("kill before each call of the owner", kills.edges, {"role": "owner", "stride": 1}, {"role": "owner", "stride": 40}),
    case("kill before each call of a worker", kills.edges, {"role": "worker", "stride": 1}, {"role": "worker", "stride": 20}),
    case("power cut before a random call", kills.power_cuts, {"cuts": 400}, {"cuts": 10}),
    case("power cut, real engine", kills.power_cuts, {"cuts": 20, "document": REAL}, {"cuts": 1, "document": REAL}),
]
