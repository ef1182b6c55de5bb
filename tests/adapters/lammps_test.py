#!/usr/bin/python3
"""Tests of the parts of adapters/lammps that need no LAMMPS: python3 -m unittest, or this file."""
import json
import os
import signal
import subprocess
import sys
import tempfile
import types
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../adapters/lammps"))
import lammps
import scratch
from identity import engine_identity
from input_script import commands
from realisation import Realisation, check_chunks, ending_of, lammps_seed
from scene import Chunk, Refused, read_scene

GOOD = {
    "variables": {"rate": 0.1, "style": "lj"},
    "steps": {"equilibration": 250, "production": 1000, "chunk": 400},
    "observables": {"viscosity": {"column": "v_eta"}, "msd": {"column": "c_msd[4]", "take": "last"}},
}
POINT = "ab" * 32

# Output of Debian 12's version: a set-up run, then the run that counts.
OUTPUT = """LAMMPS (29 Sep 2021 - Update 2)
thermo ${every}
thermo 50
run 50
Setting up Verlet run ...
  Unit style    : lj
  Current step  : 0
  Time step     : 0.005
Per MPI rank memory allocation (min/avg/max) = 3.198 | 3.198 | 3.198 Mbytes
Step Temp
       0            7
      50            8
Loop time of 0.1 on 1 procs for 50 steps with 500 atoms
Per MPI rank memory allocation (min/avg/max) = 3.198 | 3.198 | 3.198 Mbytes
   Step          Temp          v_eta     c_msd[4]
        50   1              -2             0
WARNING: something to think about
       100   1.5            3e-2           4
       150   2              5              9
Loop time of 0.417082 on 1 procs for 100 steps with 500 atoms
"""


def with_value(pointer, value):
    scene = json.loads(json.dumps(GOOD))
    *way, last = pointer.split("/")[1:]
    inner = scene
    for part in way:
        inner = inner[part]
    inner[last] = value
    return scene


def heard(text, steps=100):
    thermo = lammps.Thermo(steps)
    for line in text.splitlines():
        thermo.hear(line)
    return thermo


def realisation(folder, seed=3):
    job = {"point": POINT, "seed": seed, "checkpoint": os.path.join(folder, "checkpoint")}
    return Realisation(job, read_scene(GOOD), {"version": "1"}, folder)


class Scenes(unittest.TestCase):
    def test_chunks_follow_from_the_scene_and_do_not_cross_phases(self):
        self.assertEqual(
            read_scene(GOOD).chunks(),
            [Chunk("equilibration", 250), Chunk("production", 400), Chunk("production", 400), Chunk("production", 200)],
        )

    def test_without_a_chunk_there_is_one_for_each_phase(self):
        scene = read_scene({"steps": {"production": 1e3}, "observables": GOOD["observables"]})
        self.assertEqual(scene.chunks(), [Chunk("production", 1000)])

    def test_numbers_reach_lammps_exactly(self):
        self.assertEqual(float(read_scene(with_value("/variables/rate", 0.1 + 0.2)).variables["rate"]), 0.1 + 0.2)

    def test_faults_are_refused_where_they_are(self):
        for pointer, value in (
            ("/variables/rate", True),
            ("/variables/rate", None),
            ("/variables/rate", "two words"),
            ("/variables/rate", "$(quit)"),
            ("/variables/rate", "-log"),
            ("/variables/seed", 5),
            ("/variables/a-b", 5),
            ("/variables", []),
            ("/steps/production", 0),
            ("/steps/production", 2.5),
            ("/steps/equilibration", -1),
            ("/steps/chunk", 0),
            ("/steps/chunk", 2**31),
            ("/steps/total", 5),
            ("/observables", {}),
            ("/observables/msd", {"column": 4}),
            ("/observables/msd", "c_msd[4]"),
            ("/observables/msd/take", "median"),
            ("/viscosity", 1),
        ):
            with self.assertRaises(Refused, msg=f"{pointer} {value}") as caught:
                read_scene(with_value(pointer, value))
            self.assertTrue(caught.exception.pointer.startswith(pointer), caught.exception)
        for scene in ({}, [], 5, {"steps": {"production": 5}}):
            with self.assertRaises(Refused):
                read_scene(scene)

    def test_chunks_that_end_between_rows_are_refused_where_they_are(self):
        for steps, pointer, value in (
            ({"production": 1000, "chunk": 400}, "/steps/chunk", "400"),
            ({"production": 1000}, "/steps/production", "1000"),
            ({"production": 1000, "chunk": 300}, "/steps/production", "100"),
        ):
            scene = read_scene({"steps": steps, "observables": GOOD["observables"]})
            with self.assertRaises(Refused) as caught:
                check_chunks(scene, "production", 300)
            self.assertEqual((caught.exception.pointer, caught.exception.value), (pointer, value))
        scene = read_scene({"steps": {"production": 900, "chunk": 600}, "observables": GOOD["observables"]})
        for every in (300, 0):
            check_chunks(scene, "production", every)


class Seeds(unittest.TestCase):
    def test_no_two_chunks_of_a_point_share_one_and_all_are_ones_that_lammps_takes(self):
        seeds = [lammps_seed(POINT, seed, number, 7) for seed in range(3000) for number in range(7)]
        self.assertEqual(len(set(seeds)), len(seeds))
        self.assertTrue(1 <= min(seeds) and max(seeds) <= 900000000)

    def test_points_have_others(self):
        self.assertNotEqual(lammps_seed(POINT, 0, 0, 7), lammps_seed("cd" * 32, 0, 0, 7))


class ThermoOutput(unittest.TestCase):
    def test_the_last_run_counts(self):
        thermo = heard(OUTPUT)
        self.assertEqual(
            thermo.columns, {"Step": [50, 100, 150], "Temp": [1, 1.5, 2], "v_eta": [-2, 0.03, 5], "c_msd[4]": [0, 4, 9]}
        )
        self.assertEqual((thermo.steps_done(), thermo.timestep, thermo.atoms), (100, 0.005, 500))

    def refusal(self, text, steps=100):
        """Returns the error of this output."""
        with self.assertRaises(lammps.LammpsError) as caught:
            heard(text, steps).check()
        return str(caught.exception)

    def test_several_lines_per_sample_are_refused(self):
        multi = OUTPUT.replace("   Step          Temp", "---------------- Step 50 ----- CPU = 0.0 (sec)")
        yaml = OUTPUT.replace("   Step ", "---\nkeywords: ['Step', 'Temp', ]\ndata:\n   Step ")
        for text in (multi, yaml, OUTPUT.replace("Step ", "Stop "), ""):
            self.assertIn("one line per sample", self.refusal(text))

    def test_what_the_script_prints_between_rows_is_none(self):
        for line in (
            "60 1e6 5.0 1.0",
            "1000 1e6 5.0 1.0",
            "0 1e6 5.0 1.0",
            "100.5 1e6 5.0 1.0",
            "nan 1 1 1",
            "100 1e6",
            "x 1 1 1",
        ):
            thermo = heard(OUTPUT.replace("WARNING", f"{line}\nWARNING"))
            thermo.check()
            self.assertEqual(thermo.columns["v_eta"], [-2, 0.03, 5], line)

    def test_a_line_that_may_be_a_row_is_refused(self):
        for line in ("50 1e6 5.0 1.0", "100 1e6 5.0 1.0", "150 1e6 5.0 1.0"):
            said = self.refusal(OUTPUT.replace("WARNING", f"{line}\nWARNING"))
            self.assertIn("look like rows of thermo output: Step is", said)

    def test_a_missing_row_is_noticed(self):
        self.assertIn("2 rows of 3", self.refusal(OUTPUT.replace("       100   1.5", "       100   1.5 WARNING")))

    def test_a_run_whose_rows_are_not_plain_numbers_is_refused(self):
        named = OUTPUT  # thermo_modify format 1 "step=%d"
        for row in ("        50   1   ", "       100   1.5", "       150   2   "):
            named = named.replace(row, "step=" + row.strip())
        self.assertIn("has no row of plain numbers", self.refusal(named))

    def test_runs_begin_and_end_with_a_row(self):
        late = OUTPUT.replace("thermo 50", "thermo 40")
        self.assertIn("100 steps from step 50, and rows of thermo output every 40", self.refusal(late))
        self.assertEqual(heard(OUTPUT.replace("thermo 50", "")).columns["Step"], [50, 150])

    def test_without_a_number_of_steps_between_rows_nothing_tells_them(self):
        for said in ("thermo v_steps", "thermo 50\necho none", 'thermo "50"'):
            self.assertIn("must give thermo a number of steps", self.refusal(OUTPUT.replace("thermo 50", said)))
        heard(OUTPUT.replace("thermo 50", 'if "1 == 1" then "thermo 10" # thermo 20\n  thermo 50   # of 100')).check()

    def test_columns_of_one_name_are_refused(self):
        self.assertIn("same name", self.refusal(OUTPUT.replace("c_msd[4]", "v_eta")))

    def test_a_warning_before_the_heading_is_no_heading(self):
        heard(OUTPUT.replace("   Step   ", "WARNING: of another rank\n   Step   ")).check()

    def test_rows_of_lammps_itself_are_told_from_the_rest(self):
        begin = """
            variable every equal 30+20
            region box block 0 5 0 5 0 5
            create_box 1 box
            create_atoms 1 single 1 1 1
            mass 1 1
            thermo_style custom step temp vol
            thermo ${every}
            """
        printed = 'fix printed all print 20 "$(step) 5 6" screen yes\n'
        cases = (
            (0, printed + "run ${steps}", [0]),
            (50, printed + "run ${steps}", [0, 50]),
            (100, printed + "run ${steps}", "Step is 100 in"),
            (100, "thermo_modify format line '%ld %.3g %.3g'\nrun ${steps}", [0, 50, 100]),
            (100, "run 30\nreset_timestep 0\nrun ${steps}", [0, 50, 100]),
            (100, "run ${steps}\nrun ${steps} pre no", [100, 150, 200]),
            (100, "run ${steps} pre no post no", [0, 50, 100]),
            (100, "run 30\nrun ${steps}", "from step 30"),
            (100, "variable i loop 2\nlabel again\nrun 50\nnext i\njump SELF again", "made 50"),
            (100, "run ${steps} every 50 'print next'", "made 50"),
            (100, "run ${steps}\nrun 0", "made 0"),
            (100, "thermo_modify line multi\nrun ${steps}", "one line per sample"),
        )
        for steps, end, expected in cases:
            with tempfile.TemporaryDirectory() as folder, self.subTest(end, steps=steps):
                with open(os.path.join(folder, "in"), "w") as file:
                    file.write(begin + end)
                if isinstance(expected, str):
                    with self.assertRaisesRegex(lammps.LammpsError, expected):
                        self.ran(folder, steps)
                else:
                    self.assertEqual(self.ran(folder, steps).columns["Step"], expected)

    def ran(self, folder, steps):
        with lammps.Lammps("lmp", [], "in", folder, {"steps": steps}) as process, open(os.devnull) as nobody:
            while process.listen(nobody, 1)[0]:
                pass
            return process.finish()

    def test_numbers_that_are_none_are_noticed(self):
        self.assertTrue(heard(OUTPUT).is_finite())
        self.assertFalse(heard(OUTPUT.replace("3e-2", "-nan")).is_finite())

    def test_an_error_of_the_simulation_is_an_ending_and_one_of_the_script_is_not(self):
        for said, cause in (
            ("ERROR: Lost atoms: original 500 current 499 (src/thermo.cpp:481)", "lost-atoms"),
            ("ERROR on proc 0: Bond atoms 1 2 missing on proc 0 at step 9 (src/ntopo_bond_all.cpp:63)", "lost-atoms"),
            ("ERROR on proc 0: Non-numeric box dimensions - simulation unstable (src/domain.cpp:285)", "non-finite"),
            ("ERROR: Unknown command: fxi (src/input.cpp:232)", None),
        ):
            self.assertEqual(ending_of(lammps.LammpsError(heard(said).error)), cause)


# The output shows how LAMMPS reads each line; `hidden` must not appear.
SCRIPT = b"""# a comment
variable a index 1   # of the run

print "one # is no comment"   # but this is
print 'nor "is # this'
print "two&
-in-one   &
  line"
# a comment goes on too &
print hidden
   # indented, with ""\" inside, which is odd, so
print hidden
# until here ""\"
print ""\"three
lines # of text
""\" # and a comment
print "${a} &"   # a comment hides its own end &
 hidden
print last"""


class Scripts(unittest.TestCase):
    def said(self, script):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "in"), "wb") as file:
                file.write(script)
            return subprocess.run(
                ["lmp", "-in", "in", "-log", "none", "-echo", "none"],
                cwd=folder,
                env=lammps.ENVIRONMENT,
                capture_output=True,
                stdin=subprocess.DEVNULL,
            ).stdout.split(b"Total wall time")[0]

    def test_lammps_does_the_same_without_what_is_left_out(self):
        said = self.said(SCRIPT)
        self.assertIn(b"last", said)
        self.assertNotIn(b"hidden", said)
        self.assertEqual(self.said(commands(SCRIPT)), said)
        for left_out in (b"comment", b"\n\n", b"hidden"):
            self.assertNotIn(left_out, commands(SCRIPT).replace(b"no comment", b""))

    def test_another_comment_is_the_same_engine_and_another_word_is_not(self):
        def identity(script, launcher=()):
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "in.script")
                with open(path, "wb") as file:
                    file.write(script)
                return engine_identity("/usr/bin/lmp", list(launcher), path, [])

        original = identity(SCRIPT)
        for same in (
            SCRIPT.replace(b"of the run", b"of every run"),
            b"\n# new\n" + SCRIPT + b"\n\n",
            SCRIPT.replace(b"\n", b"\r\n"),
        ):
            self.assertEqual(identity(same) == original, b"three\r\n" not in same, same)
        for other in (
            SCRIPT.replace(b"one #", b"two #"),
            SCRIPT.replace(b"of text", b"of texts"),
            SCRIPT.replace(b"index 1 ", b"index 2 "),
            SCRIPT.replace(b"too &", b"too"),
            SCRIPT + b"\nprint more",
        ):
            self.assertNotEqual(identity(other), original, other)
        self.assertNotEqual(identity(SCRIPT, ("mpirun", "-np", "2")), original)


class Endings(unittest.TestCase):
    def end(self, status, is_launched, text=OUTPUT):
        lammps.Lammps.finish(
            types.SimpleNamespace(
                process=types.SimpleNamespace(wait=lambda: status), thermo=heard(text), is_launched=is_launched
            )
        )

    def test_a_kill_is_nobodys_fault_whether_it_hits_lmp_or_a_rank_of_it(self):
        for status, is_launched in ((-signal.SIGKILL, False), (-signal.SIGTERM, True), (128 + signal.SIGKILL, True)):
            with self.assertRaises(lammps.KilledFromOutside):
                self.end(status, is_launched)

    def test_what_lammps_says_itself_is_no_kill(self):
        for status, is_launched, text in (
            (128 + signal.SIGKILL, False, OUTPUT),
            (128 + signal.SIGSEGV, True, OUTPUT),
            (128 + signal.SIGTERM, True, OUTPUT + "ERROR: Lost atoms\n"),
            (1, True, OUTPUT),
        ):
            with self.assertRaises(lammps.LammpsError):
                self.end(status, is_launched, text)


class Samples(unittest.TestCase):
    def run_through(self, folder):
        """Runs all chunks in LAMMPS' place: v_eta counts rows from 1, c_msd[4] squares them."""
        run = realisation(folder)
        count = 0
        while not run.has_ended():
            with open(os.path.join(folder, "after_restart"), "w") as file:
                file.write(f"state {run.number}")
            rows = run.chunks[run.number].steps // 10 if run.chunks[run.number].phase == "production" else 2
            values = [1e9] + [count + row for row in range(1, rows + 1)]
            run.advance(
                types.SimpleNamespace(
                    columns={"Step": values, "v_eta": values, "c_msd[4]": [v * v for v in values]},
                    timestep=0.005,
                    is_finite=lambda: True,
                )
            )
            count += rows if run.chunks[run.number - 1].phase == "production" else 0
        return run

    def test_means_leave_out_equilibration_and_the_row_that_two_chunks_share(self):
        with tempfile.TemporaryDirectory() as folder:
            result = self.run_through(folder).result({})
        self.assertEqual(result["mean"], {"viscosity": 50.5, "msd": 10000})
        self.assertEqual(
            (result["steps"], result["time"]),
            ({"equilibration": 250, "production": 1000}, {"equilibration": 1.25, "production": 5.0}),
        )
        self.assertEqual(list(result["blocks"]), ["viscosity"])
        self.assertEqual(len(result["blocks"]["viscosity"]), 32)
        self.assertEqual(result["blocks"]["viscosity"][0], 2)  # mean of 1, 2, 3

    def test_a_checkpoint_is_taken_over_and_a_torn_or_strange_one_is_not(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "checkpoint")
            self.run_through(folder).save()
            with open(path, "rb") as file:
                whole = file.read()
            resumed = realisation(folder)
            resumed.resume()
            self.assertEqual((resumed.number, resumed.mean()), (4, {"viscosity": 50.5, "msd": 10000}))
            for content in (whole[:-1], whole[:40], b"", whole.replace(b'"version": "1"', b'"version": "2"')):
                with open(path, "wb") as file:
                    file.write(content)
                fresh = realisation(folder)
                fresh.resume()
                self.assertEqual((fresh.number, fresh.restart, fresh.samples["msd"]), (0, b"", []))
            with open(path, "wb") as file:
                file.write(whole)
            other = realisation(folder, seed=4)
            other.resume()
            self.assertEqual(other.number, 0)


class Folders(unittest.TestCase):
    def test_those_of_the_dead_are_removed_and_those_of_the_living_are_not(self):
        with tempfile.TemporaryDirectory() as parent:
            tempfile.tempdir = parent
            try:
                with scratch.folder_with([__file__]) as living:
                    dead = os.path.join(parent, scratch.PREFIX + "dead")
                    other = os.path.join(parent, "other")
                    os.mkdir(dead)
                    os.mkdir(other)
                    scratch.remove_left_folders()
                    self.assertTrue(os.path.exists(os.path.join(living, os.path.basename(__file__))))
                    self.assertEqual(sorted(os.listdir(parent)), sorted([os.path.basename(living), "other"]))
                self.assertEqual(os.listdir(parent), ["other"])
            finally:
                tempfile.tempdir = None


if __name__ == "__main__":
    unittest.main()
