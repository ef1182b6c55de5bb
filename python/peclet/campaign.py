"""Campaigns that are built here and run by the program."""
import json
import os
import subprocess

from peclet.program import PecletError, ask, find_program
from peclet.results import open_results

# Codes of `peclet run` that are no error: all converged; finished, but not all; stopped, and goes on when run again.
ENDED, STOPPED = (0, 3), 75


class Campaign:
    """A scene, a sweep over it and a target.

        campaign = peclet.Campaign("friction", scene, {"/contact/friction": [0, 0.5, 1]}, tolerance=0.05)
        results = campaign.run()

    scene       a dictionary, or the path of a JSON file
    sweep       values by JSON pointer into the scene, all of one combined with all of the others; or the list of
                entries that a campaign file has
    observable, tolerance, confidence    of the target, the tolerance relative to the mean
    minimum, maximum                     seeds of a point
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
        **more,
    ):
        if not isinstance(scene, dict):
            with open(scene, encoding="utf-8") as file:
                scene = json.load(file)
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

    def write(self, path=None):
        """Writes the campaign file, NAME.json unless told otherwise, and returns its path."""
        path = os.fspath(path) if path else self.document["name"] + ".json"
        with open(path, "w", encoding="utf-8") as file:
            json.dump(self.document, file, indent=1)
            file.write("\n")
        return path

    def validate(self, path=None, program=None):
        """Writes the file and returns what `peclet validate` says of every point: time step, groups and warnings.
        PecletError says what is wrong, and where."""
        return json.loads(ask(program, "validate", "--json", "--", self.write(path)))["points"]

    def run(self, path=None, program=None, options=()):
        """Writes the file, runs the campaign until every point is decided, or goes on where it was stopped, and returns
        its results. What `peclet run` prints is shown; `options` are more of its options, such as "--workers=4"."""
        path = self.write(path)
        done = subprocess.run([find_program(program), "run", *options, "--", path])
        if done.returncode == STOPPED:
            raise PecletError(f"{path}: stopped; run it again to go on")
        if done.returncode not in ENDED:
            raise PecletError(f"{path}: peclet run ended with {done.returncode}")
        return open_results(path, program)
