"""results_elsewhere.py PECLET FAKE_ENGINE

Runs the commands of schema/README.md that read results in the sqlite3 shell.
"""
import csv
import io
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

PECLET, FAKE_ENGINE = map(os.path.abspath, sys.argv[1:3])
README = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "schema", "README.md")
OBSERVABLE = "relative_viscosity"  # the one that the fake engine has


def recipe():
    with open(README) as file:
        [script] = re.findall(r"```sh\n(peclet results.*?)```", file.read(), re.S)
    return script.replace("first_normal_difference", OBSERVABLE)


class Elsewhere(unittest.TestCase):
    def test_the_shell_of_sqlite_reads_results_as_the_documentation_says(self):
        with tempfile.TemporaryDirectory() as folder:
            campaign = {
                "name": "flow-curve",
                "scene": {"volume_fraction": 0.5},
                "sweep": [{"set": "/peclet", "values": [1, 10]}],
                "target": {"observable": OBSERVABLE, "relative_tolerance": 0.05},
                "realisations": {"minimum": 8, "maximum": 60},
                "engine": [FAKE_ENGINE],
            }
            with open(os.path.join(folder, "flow-curve.json"), "w") as file:
                json.dump(campaign, file)
            path = os.path.dirname(PECLET) + os.pathsep + os.environ["PATH"]
            options = {
                "cwd": folder,
                "text": True,
                "check": True,
                "stdout": subprocess.PIPE,
                "env": {**os.environ, "PATH": path},
            }
            subprocess.run([PECLET, "run", "flow-curve.json", "--workers", "2", "--quiet"], **options)
            said = subprocess.run(["bash", "-e", "-o", "pipefail", "-c", recipe()], **options).stdout
            rows = list(csv.reader(io.StringIO(said)))
            points = json.loads(subprocess.run([PECLET, "export", "flow-curve.json"], **options).stdout)["points"]
            self.assertEqual([row[0] for row in rows], [point["label"] for point in points])
            for (label, seeds, verdict, mean), point in zip(rows, points):
                self.assertEqual((int(seeds), verdict), (point["stop_test"]["seeds"], "converged"))
                # Both means are of the same seeds, summed in different order.
                self.assertAlmostEqual(float(mean) / point["quantities"][OBSERVABLE]["mean"], 1, places=12, msg=label)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
