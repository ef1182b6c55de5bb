#!/usr/bin/python3
"""mutations.py FOLDER [--named] [--only WORD] [--jobs N]  break the physics in a copy of the source and see who notices
mutations.py --check                                    only see that every mutation still applies

Each mutation is one change of a line of the engine. It is made in FOLDER, a copy of the source that this script makes,
and built there. The coarse ones (mutations.py) are shown to the quick forms of the studies and to the tests of the
engine and of the physics; the fine ones (named_mutations.py, --named) each to the one test of seconds that has to
notice it. A mutation that is missed is an error. Prints a table, and writes it to its half of mutations.md beside this
script when all were tried. Some four minutes of two cores for each coarse mutation, a minute for each fine one; a
second call with FOLDER goes on where the first one was stopped, if the source has the same commit and no changes.
"""
import argparse
import datetime
import json
import os
import re
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(SOURCE, "results"))
from studies.command_line import processor
from named_mutations import NAMED

# What is broken; file, text in it that occurs once, and what takes its place.
MUTATIONS = [
    (
        "plus sign in the second Brownian torque",
        "engine/terms/pair_noise.h",
        "root.pump_second * turned - root.spin_second * spun",
        "root.pump_second * turned + root.spin_second * spun",
    ),
    (
        "noise of half the variance",
        "engine/kernels/pair_pass.cpp",
        "std::sqrt(2 * physics.thermal_energy / timestep)",
        "std::sqrt(physics.thermal_energy / timestep)",
    ),
    (
        "image velocity missing",
        "engine/state/periodic_cell.cpp",
        "edge_velocities_ = velocity_gradient_ * edges_;",
        "edge_velocities_ = 0 * (velocity_gradient_ * edges_);",
    ),
    (
        "torque coupling of lubrication omitted",
        "engine/terms/pair_resistance.h",
        "      .pump_first = k.pump_first * pump,\n      .pump_second = k.pump_second * pump,\n",
        "      .pump_first = 0.0 * pump,\n      .pump_second = 0.0 * pump,\n",
    ),
    (
        "squeeze mode doubled",
        "engine/terms/pair_resistance.h",
        ".squeeze_inverse = six * 2 * b * b / cube",
        ".squeeze_inverse = six * 4 * b * b / cube",
    ),
    (
        "shear mode with another sign",
        "engine/terms/lubrication.h",
        "(R.squeeze * closing) * n + R.shear * sliding",
        "(R.squeeze * closing) * n - R.shear * sliding",
    ),
    (
        "every pair counted twice in the stress",
        "engine/observables/production.cpp",
        "block.stress[t] += sums.stress[t];",
        "block.stress[t] += 2 * sums.stress[t];",
    ),
    (
        "contact half as stiff",
        "engine/terms/contact.h",
        "return normal_stiffness * overlap;",
        "return 0.5 * normal_stiffness * overlap;",
    ),
    (
        "spheres carried round the wrong way",
        "engine/flow/background_flow.h",
        "0.5 * (x.y - y.x)};",
        "-0.5 * (x.y - y.x)};",
    ),
    (
        "drag of a slip sphere",
        "engine/terms/drag.h",
        "return 6 * std::numbers::pi * viscosity * radius;",
        "return 4 * std::numbers::pi * viscosity * radius;",
    ),
    (
        "hollow spheres",
        "engine/state/particles.cpp",
        "particles.inertia.push_back(0.4 * mass",
        "particles.inertia.push_back(2.0 / 3 * mass",
    ),
    (
        "friction twice as strong",
        "engine/terms/friction.h",
        "return (contact.friction / contact.tangential_stiffness)",
        "return (2 * contact.friction / contact.tangential_stiffness)",
    ),
    (
        "contact spring that is not turned",
        "engine/terms/tangential_spring.h",
        "Vector3Of<Real> turned = across(spring, normal);",
        "Vector3Of<Real> turned = spring + Real{0.0} * across(spring, normal);",
    ),
    ("repulsion of twice the range", "engine/terms/repulsion.h", ".decay = 1 / length", ".decay = 0.5 / length"),
    (
        "structural stress from one side of each pair",
        "engine/observables/structure.cpp",
        "within(kind.radius_first) + within(kind.radius_second)",
        "within(kind.radius_first)",
    ),
    (
        "gap clamped at ten times the inner gap",
        "engine/terms/pair_resistance.h",
        "pair.surface_distance(), Real{inner_gap})",
        "pair.surface_distance(), Real{10 * inner_gap})",
    ),
]

STUDIES = [
    "convergence",
    "diffusion",
    "divergence",
    "flow-curve",
    "friction-repulsion",
    "inertia",
    "literature",
    "microstructure",
    "pair-potential",
    "zero-shear",
    "speed-accuracy",
    "stability",
]


def replaced(mutation, root):
    """Path and text of the broken file."""
    name, file, old, new = mutation[:4]
    path = os.path.join(root, file)
    with open(path) as f:
        text = f.read()
    if text.count(old) != 1:
        sys.exit(f"{name}: its text occurs {text.count(old)} times in {file}; correct the list in mutations.py")
    return path, text.replace(old, new)


def copy_of_source(folder):
    os.makedirs(folder, exist_ok=True)
    files = subprocess.run(
        ["git", "ls-files", "-z"], cwd=SOURCE, check=True, capture_output=True, text=True
    ).stdout.split("\0")
    for file in filter(None, files):
        target = os.path.join(folder, file)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        # Only what differs, so that a second call builds little.
        source = os.path.join(SOURCE, file)
        if not os.path.exists(target) or open(source, "rb").read() != open(target, "rb").read():
            shutil.copyfile(source, target)
            shutil.copymode(source, target)


def build(folder, jobs, targets=("peclet", "peclet-engine", "engine_tests", "physics_tests")):
    if not os.path.exists(os.path.join(folder, "build/release/build.ninja")):
        subprocess.run(
            ["cmake", "--preset", "release", "-DBUILD_TESTING=ON", "-DPECLET_WERROR=OFF"],
            cwd=folder,
            check=True,
            stdout=subprocess.DEVNULL,
        )
    done = subprocess.run(
        ["cmake", "--build", "--preset", "release", "--target", *targets, "--", f"-j{jobs}"],
        cwd=folder,
        capture_output=True,
        text=True,
    )
    if done.returncode != 0:
        sys.exit(f"{folder}: does not build\n{done.stdout[-3000:]}")


def failed_tests(folder, program, arguments):
    """Names of the tests that fail, or the signal that ended them."""
    try:
        done = subprocess.run(
            [os.path.join(folder, "build/release/bin", program), *arguments],
            cwd=folder,
            capture_output=True,
            text=True,
            timeout=1800,
        )
    except subprocess.TimeoutExpired:
        return ["does not end"]
    names = re.findall(r"^\[  FAILED  \] ([\w./]+)(?:, |$| \()", done.stdout, re.M)
    return sorted(set(names)) or ([] if done.returncode == 0 else [f"exit {done.returncode}"])


def who_notices(folder):
    binaries = os.path.join(folder, "build/release/bin")
    noticed = []
    for study in STUDIES:
        driver = next(d for d in ("study.py", "remake.py") if os.path.exists(os.path.join(folder, "results", study, d)))
        try:
            done = subprocess.run(
                ["/usr/bin/python3", os.path.join(folder, "results", study, driver), binaries, "--quick"],
                capture_output=True,
                timeout=1800,
            )
        except subprocess.TimeoutExpired:
            noticed.append(f"study {study} (does not end)")
            continue
        if done.returncode != 0:
            noticed.append(f"study {study}")
    for program, arguments in (
        ("engine_tests", ["--gtest_filter=-Benchmark*"]),
        ("physics_tests", ["--gtest_filter=-PairDensity*"]),
    ):
        names = failed_tests(folder, program, arguments)
        if names:
            more = f" and {len(names) - 3} more" if len(names) > 3 else ""
            noticed.append(f"{program}: {', '.join(names[:3])}{more}")
    return noticed


def who_of_the_named(folder, names):
    """Of these tests (program:test), those that fail; a program that has none of a name is an error."""
    noticed = []
    for program in sorted({name.split(":")[0] for name in names}):
        tests = [name.split(":")[1] for name in names if name.startswith(program + ":")]
        chosen = [f"--gtest_filter={':'.join(tests)}"]
        listed = subprocess.run(
            [os.path.join(folder, "build/release/bin", program), *chosen, "--gtest_list_tests"],
            capture_output=True,
            text=True,
            check=True,
        )
        if listed.stdout.count("\n  ") < len(tests):
            sys.exit(f"{program} has not all of {', '.join(tests)}")
        noticed += [f"{program}: {name}" for name in failed_tests(folder, program, chosen)]
    return noticed


def git(*arguments):
    return subprocess.run(["git", *arguments], cwd=SOURCE, check=True, capture_output=True, text=True).stdout.strip()


def commit_of_source():
    return git("rev-parse", "--short=7", "HEAD") + (
        " with changes" if git("status", "--porcelain", "--untracked-files=no") else ""
    )


def trees():
    """Of the engine and its tests: what the fine mistakes depend on. Outlives commits on other subjects."""
    folders = ("engine", "tests/engine", "tests/physics")
    return " ".join(git("rev-parse", "--short=7", f"HEAD:{folder}") for folder in folders) + (
        " with changes" if git("status", "--porcelain", *folders) else ""
    )


class Known:
    """Who noticed what, of this call and of earlier ones with the same commit; of source with changes nothing is
    kept."""

    def __init__(self, folder, commit, file):
        os.makedirs(folder, exist_ok=True)
        self.path, self.commit, self.noticed = os.path.join(folder, file), commit, {}
        self.lasting = "changes" not in commit
        if self.lasting and os.path.exists(self.path):
            with open(self.path) as f:
                stored = json.load(f)
            self.noticed = stored["noticed"] if stored["commit"] == commit else {}

    def add(self, name, noticed):
        self.noticed[name] = noticed
        if self.lasting:
            with open(self.path, "w") as f:
                json.dump({"commit": self.commit, "noticed": self.noticed}, f, indent=1)


MARK = "## Fine mistakes\n"


def halves():
    """Of mutations.md: the coarse half, and the rows of the fine one by name."""
    with open(os.path.join(HERE, "mutations.md")) as f:
        before, _, after = f.read().partition(MARK)
    rows = [line for line in after.splitlines() if line.startswith("| ") and not line.startswith("| broken")]
    return before.rstrip("\n"), {row.split(" | ")[0].removeprefix("| "): row for row in rows}


def write_halves(before, rows):
    names = ["nothing", *(mutation[0] for mutation in NAMED)]
    with open(os.path.join(HERE, "mutations.md"), "w") as f:
        f.write(
            f"{before}\n\n{MARK}\n`mutations.py --named` shows each to the one test of seconds that has to notice "
            "it. A row is made by itself (`--only WORD`); its last column is\n"
            "the tree of `engine/` that it was made with (`git rev-parse HEAD:engine`).\n\n| broken | noticed by | "
            "engine |\n|---|---|---|\n"
        )
        f.write("".join(rows[name] + "\n" for name in names if name in rows))


def coarse(folder, jobs, mutation):
    build(folder, jobs)
    return who_notices(folder)


def fine(folder, jobs, mutation):
    """Unbroken source is shown to all of the tests."""
    names = [mutation[4]] if mutation[1] else sorted({m[4] for m in NAMED})
    build(folder, jobs, sorted({name.split(":")[0] for name in names}))
    return who_of_the_named(folder, names)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", help="of the copy; kept, so that a second call goes faster")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--named", action="store_true", help="the fine ones, each before its own test")
    parser.add_argument("--only", default="", help="mutations whose name has this in it")
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    for mutation in (*MUTATIONS, *NAMED):
        replaced(mutation, SOURCE)
    if arguments.check:
        print(f"{len(MUTATIONS) + len(NAMED)} mutations apply")
        return 0
    if not arguments.folder:
        parser.error("needs a folder")
    chosen, who = (NAMED, fine) if arguments.named else (MUTATIONS, coarse)
    commit, tree = commit_of_source(), trees()
    known = Known(
        arguments.folder,
        tree if arguments.named else commit,
        "noticed-named.json" if arguments.named else "noticed.json",
    )
    before, rows = halves()
    lines = []
    missed = 0
    for mutation in [("nothing", None, None, None), *chosen]:
        if arguments.only not in mutation[0]:
            continue
        if mutation[0] not in known.noticed:
            copy_of_source(arguments.folder)
            if mutation[1]:
                path, text = replaced(mutation, arguments.folder)
                with open(path, "w") as f:
                    f.write(text)
            known.add(mutation[0], who(arguments.folder, arguments.jobs, mutation))
        noticed = known.noticed[mutation[0]]
        missed += bool(mutation[1]) != bool(noticed)
        lines.append(
            f"| {mutation[0]} | {'; '.join(noticed) or ('nobody' if mutation[1] else 'nobody, as it should be')} |"
        )
        print(lines[-1], flush=True)
        if arguments.named and known.lasting:
            rows[mutation[0]] = f"{lines[-1]} {tree.split()[0]} |"
            write_halves(before, rows)
    if not arguments.named and not arguments.only:
        write_halves(
            "# Who notices broken physics\n\nOne line of the engine is broken at a time, in a copy.\n\n## Coarse "
            "mistakes\n\n`mutations.py` shows each to the quick forms of the studies and "
            f"to all tests of the engine and of the physics. Commit {commit}, {processor()}, "
            f"{datetime.date.today().isoformat()}.\n\n"
            "| broken | noticed by |\n|---|---|\n" + "\n".join(lines),
            rows,
        )
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
