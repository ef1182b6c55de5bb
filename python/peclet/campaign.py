"""Campaigns that are built here and run by the program."""
import json
import os

from peclet.program import PecletError, ask, run_shown
from peclet.results import open_results

# Codes of `peclet run` that are no error: all converged or complete; finished, but not so; stopped, and goes on when
# run again.
ENDED, STOPPED = (0, 3), 75


class Campaign:
    """A scene, a sweep over it and a target.

        campaign = peclet.Campaign("friction", scene, {"/contact/friction": [0, 0.5, 1]}, tolerance=0.05)
        results = campaign.run()

    scene       a dictionary, or the path of a JSON file (with another name than the campaign's)
    sweep       values by JSON pointer into the scene, all of one combined with all of the others; or the list of
                entries that a campaign file has
    observable, tolerance, confidence    of the target, the tolerance relative to the mean
    minimum, maximum                     seeds of a point
    realisations                         seeds of every point, in the place of tolerance, confidence and these two
    more        other keys of a campaign file, such as engine or keep_files

    `document` is what the file has; nothing is checked before validate() or run().
    """

    def __init__(
        self,
        name,
        scene,
        sweep=None,
        *,
        observable="relative_viscosity",
        tolerance=0.05,
        confidence=0.95,
        minimum=8,
        maximum=400,
        realisations=None,
        **more,
    ):
        self._scene_file = None if isinstance(scene, dict) else os.fspath(scene)
        if self._scene_file:
            try:
                with open(scene, encoding="utf-8-sig") as file:
                    scene = json.load(file)
            except (OSError, ValueError) as error:
                why = getattr(error, "strerror", None) or error
                raise PecletError(f"{self._scene_file}: cannot be read as a scene: {why}") from error
        if isinstance(sweep, dict):
            sweep = [{"set": pointer, "values": list(values)} for pointer, values in sweep.items()]
        self.document = {
            "name": name,
            "scene": scene,
            "sweep": sweep or [],
            "target": {"observable": observable, "relative_tolerance": tolerance, "confidence": confidence},
            "realisations": {"minimum": minimum, "maximum": maximum},
            **more,
        }
        if realisations is not None:
            del self.document["target"]
            self.document.update({"show": [observable], **more, "realisations": realisations})

    def write(self, path=None):
        """Writes the campaign file, NAME.json unless told otherwise, and returns its path. A file that is there already
        must be that of an earlier campaign of this name."""
        path = os.fspath(path) if path else self.document["name"] + ".json"
        if os.path.exists(path):
            self._check_earlier(path)
        text = json.dumps(self.document, indent=1, default=plain) + "\n"
        # Whole or not at all: a part of it would be taken for something else the next time.
        temporary = f"{path}.{os.getpid()}.tmp"
        try:
            with open(temporary, "w", encoding="utf-8") as file:
                file.write(text)
            os.replace(temporary, path)
        except OSError as error:
            raise PecletError(f"{path}: cannot be written: {error.strerror}") from error
        return path

    def _check_earlier(self, path):
        """Throws PecletError if the file is something else, such as the scene."""
        try:
            with open(path, encoding="utf-8-sig") as file:
                earlier = json.load(file)
            if self._scene_file is None or not os.path.samefile(path, self._scene_file):
                if {"scene", "realisations"} <= set(earlier) and earlier["name"] == self.document["name"]:
                    return
        except (OSError, ValueError, TypeError, KeyError):
            pass
        raise PecletError(
            f"{path}: is there already and not a campaign of the name {self.document['name']}, so it is not "
            "overwritten; choose another name, or another path"
        )

    def validate(self, path=None, program=None):
        """Writes the file and returns what `peclet validate` says of every point: time step, groups and warnings.
        PecletError says what is wrong, and where."""
        return json.loads(ask(program, "validate", "--json", "--", self.write(path)))["points"]

    def run(self, path=None, program=None, options=()):
        """Writes the file, runs the campaign until every point is decided, or goes on where it was stopped, and returns
        its results. What `peclet run` prints is shown; `options` are more of its options, such as "--workers=4".
        """
        path = self.write(path)
        code, said, interrupted = run_shown(program, "run", *options, "--", path)
        if interrupted:
            raise KeyboardInterrupt(f"{path}: stopped; run it again to go on")
        if code == STOPPED:
            raise PecletError(f"{path}: stopped; run it again to go on")
        if code not in ENDED:
            raise PecletError(said or f"{path}: peclet run ended with {code}; it says why on standard error")
        return open_results(path, program)


def plain(value):
    """What JSON has for the numbers and arrays of NumPy."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise PecletError(f"{value!r}: must be something that a JSON file may hold")
