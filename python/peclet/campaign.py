"""Builds campaigns and has the program peclet run them."""
import json
import os
import re

from peclet.notebook import LiveTable, is_notebook
from peclet.program import PecletError, ask, run_shown
from peclet.results import open_results, read_status

# Exit codes of `peclet run` without an error: 0 all points converged or complete; 3 finished, but not all of them
# converged; 75 stopped, and continued by the next run.
ENDED, STOPPED = (0, 3), 75


def read_json(path):
    """Returns the content of a JSON file with or without comments. Raises OSError or ValueError."""
    with open(path, encoding="utf-8-sig") as file:
        text = file.read()
    strings_and_comments = r'("(?:[^"\\]|\\.)*")|//[^\n]*|/\*.*?\*/'
    return json.loads(re.sub(strings_and_comments, lambda found: found[1] or " ", text, flags=re.DOTALL))


class Campaign:
    """A campaign: a scene, a sweep over its parameters, and a target.

        campaign = peclet.Campaign("friction", scene, {"/contact/friction": [0, 0.5, 1]}, tolerance=0.05)
        results = campaign.run()

    name        name of the campaign
    scene       a dictionary, or the path of a JSON file (not that of the campaign file)
    sweep       lists of values, or ranges {"from": 0.01, "to": 1e4, "points": 7, "spaced": "log"}, by JSON pointer
                into the scene, all combinations of which are run; or the list of entries of a campaign file; None: a
                single point
    observable  name of the target's quantity
    tolerance   half-width of its confidence interval, relative to the mean
    confidence  level of the interval, in (0, 1)
    minimum, maximum    fewest and most seeds of a point
    realisations        a fixed number of seeds of every point; replaces the four before
    more        other keys of a campaign file, such as engine or keep_files

    `document` is the content of the campaign file, a dictionary. It is checked by validate() and run(), not before.
    Raises PecletError if the file of the scene cannot be read.
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
                scene = read_json(scene)
            except (OSError, ValueError) as error:
                why = getattr(error, "strerror", None) or error
                raise PecletError(f"{self._scene_file}: cannot be read as a scene: {why}") from error
        if isinstance(sweep, dict):
            sweep = [
                {"set": pointer, "values": values if isinstance(values, dict) else list(values)}
                for pointer, values in sweep.items()
            ]
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
        """Writes the campaign file and returns its path.

        path    path of the file; NAME.json in the working folder by default

        Raises PecletError if the file cannot be written, or exists and is not a campaign of this name.
        """
        path = self._path(path)
        if os.path.exists(path):
            self._check_earlier(path)
        text = json.dumps(self.document, indent=1, default=plain) + "\n"
        # Renamed when complete: a part of a campaign would not be recognised as one by the next write().
        temporary = f"{path}.{os.getpid()}.tmp"
        try:
            with open(temporary, "w", encoding="utf-8") as file:
                file.write(text)
            os.replace(temporary, path)
        except OSError as error:
            raise PecletError(f"{path}: cannot be written: {error.strerror}") from error
        return path

    def _path(self, path):
        return os.fspath(path) if path else self.document["name"] + ".json"

    def _check_earlier(self, path):
        """Raises PecletError if the file is not a campaign of this name, for example if it is the scene."""
        try:
            earlier = read_json(path)
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
        """Writes the campaign file and returns the answer of `peclet validate`.

        path       path of the campaign file, as for write()
        program    path or name of the program peclet, as for peclet.open()

        Returns a list of dictionaries, one for each point: time step, dimensionless groups, warnings. Raises
        PecletError with the place of the fault if the campaign cannot be run.
        """
        return json.loads(ask(program, "validate", "--json", "--", self.write(path)))["points"]

    def run(self, path=None, program=None, options=()):
        """Writes the campaign file, runs the campaign until every point is decided, and returns its Results.

        path       path of the campaign file, as for write()
        program    path or name of the program peclet, as for peclet.open()
        options    further options of `peclet run`, such as ["--workers=4"]

        Shows the output of `peclet run`; in a notebook a bar and a table that are kept up to date, unless options have
        "--quiet" or "--jsonl". A campaign that was stopped continues. Raises PecletError if it fails or is stopped,
        KeyboardInterrupt if it is interrupted.
        """
        path = self.write(path)
        show = None
        if is_notebook() and not {"--quiet", "--jsonl"} & set(options):
            show, options = LiveTable(lambda: read_status(path, program)), [*options, "--quiet"]
        code, said, interrupted = run_shown(program, "run", *options, "--", path, show=show)
        if interrupted:
            raise KeyboardInterrupt(f"{path}: stopped; run it again to go on")
        if code == STOPPED:
            raise PecletError(f"{path}: stopped; run it again to go on")
        if code not in ENDED:
            raise PecletError(said or f"{path}: peclet run ended with {code}; it says why on standard error")
        return open_results(path, program)

    def status(self, path=None, program=None):
        """Returns the state of the campaign as a Table, also while it runs; see Results.status().

        path       path of the campaign file, as for write(); it is only read
        program    path or name of the program peclet, as for peclet.open()

        Raises PecletError if the campaign has not been run yet.
        """
        return open_results(self._path(path), program).status()


def plain(value):
    """Returns numbers and arrays of NumPy as JSON can hold them. Raises PecletError for other objects."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise PecletError(f"{value!r}: must be something that a JSON file may hold")
