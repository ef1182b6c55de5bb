"""Checks the scene of a campaign whose engine is LAMMPS, and divides its steps into chunks."""
import dataclasses
import json
import re

# Variables that the adapter sets for every chunk; README.md explains them.
OWN_VARIABLES = ("from", "to", "steps", "phase", "seed")
MOST_STEPS = 2**31 - 1


class Refused(Exception):
    """A scene that cannot be run: the JSON pointer of the fault, the value there, and what is allowed."""

    def __init__(self, pointer, value, allowed):
        super().__init__(f"{pointer}: {value}: {allowed}")
        self.pointer, self.value, self.allowed = pointer, value, allowed


@dataclasses.dataclass(frozen=True)
class Chunk:
    """The steps of one LAMMPS process."""

    phase: str
    steps: int


@dataclasses.dataclass(frozen=True)
class Observable:
    column: str  # of the thermo output
    take: str  # "mean" over the production window, or "last"


@dataclasses.dataclass(frozen=True)
class Scene:
    """A checked scene: variables of the script by name, steps of the phases and of a chunk, Observables by name."""

    variables: dict
    equilibration: int
    production: int
    chunk: int
    observables: dict

    def chunks(self):
        """Returns the chunks, which depend on the scene alone, because the trajectory depends on its division."""
        chunks = []
        for phase, steps in (("equilibration", self.equilibration), ("production", self.production)):
            chunks += [Chunk(phase, min(self.chunk, steps - done)) for done in range(0, steps, self.chunk)]
        return chunks


def refuse(pointer, value, allowed):
    raise Refused(pointer, json.dumps(value), allowed)


def check_object(value, pointer, required=(), optional=()):
    """Raises Refused unless the value is an object with all required keys and no other but the optional ones."""
    if not isinstance(value, dict):
        refuse(pointer, value, "must be an object")
    for key in value:
        if key not in (*required, *optional):
            refuse(
                f"{pointer}/{escaped(key)}", value[key], f"is unknown; known are {', '.join((*required, *optional))}"
            )
    for key in required:
        if key not in value:
            refuse(f"{pointer}/{key}", None, "is required")


def escaped(key):
    """Returns the key as a part of a JSON pointer."""
    return key.replace("~", "~0").replace("/", "~1")


def steps_at(steps, key, least, default=None):
    """Returns the whole number at /steps/`key`. Raises Refused if it is not one between `least` and MOST_STEPS."""
    value = steps.get(key, default)
    if isinstance(value, float) and value.is_integer():
        value = int(value)  # 1e5 is a whole number, too
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= MOST_STEPS:
        refuse(f"/steps/{key}", value, f"must be an integer >= {least} and <= {MOST_STEPS}")
    return value


def read_variables(variables):
    """Returns the variables as texts, by name. Raises Refused if LAMMPS could not take one on its command line."""
    check_object(variables, "/variables", optional=variables if isinstance(variables, dict) else ())
    for name, value in variables.items():
        pointer = f"/variables/{escaped(name)}"
        if not re.fullmatch(r"[A-Za-z0-9_]+", name):
            refuse(pointer, value, "must have a name of letters, digits and underscores")
        if name in OWN_VARIABLES:
            refuse(pointer, value, f"is set by the adapter, as are {', '.join(OWN_VARIABLES)}")
        is_word = isinstance(value, str) and re.fullmatch(r"[^\s\"'$&#]+", value) and not value.startswith("-")
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        if not is_word and not is_number:
            refuse(
                pointer, value, "must be a number or a word without blanks, quotes, $, & and #, and without a leading -"
            )
    return {name: value if isinstance(value, str) else f"{value:.17g}" for name, value in variables.items()}


def read_observables(observables):
    if not isinstance(observables, dict) or not observables:
        refuse("/observables", observables, "must be an object with one observable or more")
    read = {}
    for name, about in observables.items():
        pointer = f"/observables/{escaped(name)}"
        check_object(about, pointer, required=("column",), optional=("take",))
        if not isinstance(about["column"], str):
            refuse(f"{pointer}/column", about["column"], "must be the heading of a column of LAMMPS' thermo output")
        if about.get("take", "mean") not in ("mean", "last"):
            refuse(f"{pointer}/take", about["take"], "must be one of: mean, last")
        read[name] = Observable(about["column"], about.get("take", "mean"))
    return read


def read_scene(scene):
    """Returns the Scene of a JSON document. Raises Refused."""
    check_object(scene, "", required=("steps", "observables"), optional=("variables",))
    check_object(scene["steps"], "/steps", required=("production",), optional=("equilibration", "chunk"))
    production = steps_at(scene["steps"], "production", 1)
    return Scene(
        variables=read_variables(scene.get("variables", {})),
        equilibration=steps_at(scene["steps"], "equilibration", 0, 0),
        production=production,
        chunk=steps_at(scene["steps"], "chunk", 1, production),
        observables=read_observables(scene["observables"]),
    )
