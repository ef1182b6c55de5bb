#!/usr/bin/python3
"""mutations.py FOLDER [--named] [--only WORD] [--jobs N]  breaks the physics in a copy and lists failures
mutations.py --check [--compiler COMMAND]               checks that every mutation still applies and compiles

Each mutation changes a line of the engine. It is made and built in FOLDER, a copy of the source. The coarse
ones (coarse_mutations.py) are tried with the quick forms of the studies and all tests of the engine and the
physics. The fine ones (named_mutations.py, --named) are tried each with the one test of seconds that must
fail. A mutation without a failure is an error, and so is a test that ends by a signal. Prints a table, and
writes it to its half of mutations.md after a complete run. A coarse mutation takes about four minutes of two
cores, a fine one a minute. A second call with FOLDER continues a stopped one at the same commit.
"""
import argparse
import concurrent.futures
import datetime
import glob
import hashlib
import json
import os
import re
import shlex
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(SOURCE, "results"))
from studies.command_line import processor
from coarse_mutations import COARSE
from named_mutations import NAMED

CRASH = "ended by signal"
STUDIES = """
    at-rest contacts control-variates convergence diffusion divergence equation-of-state flow-curve friction-repulsion
    inertia inhomogeneous-flow large-friction learned-rheology literature microstructure mixtures mixtures-map
    mixtures-noise monti-silica monti-viscosity monti-waves oscillation other-flows pair-potential zero-shear
    speed-accuracy stability steady-state stress-control
""".split()


def replaced(mutation, root):
    """Returns the path and the text of the changed file."""
    name, file, old, new = mutation[:4]
    path = os.path.join(root, file)
    with open(path) as f:
        text = f.read()
    if text.count(old) != 1:
        sys.exit(f"{name}: its text occurs {text.count(old)} times in {file}; correct its text in tests/mutations")
    return path, text.replace(old, new)


def errors_of(mutations, file, root, compiler):
    """Returns the first compiler messages for a file with all of these mutations, or None if two overlap."""
    with open(os.path.join(root, file)) as f:
        text = f.read()
    end = len(text)
    for place, old, new in sorted(((text.index(m[2]), m[2], m[3]) for m in mutations), reverse=True):
        if place + len(old) > end:
            return None
        text, end = text[:place] + new + text[place + len(old) :], place
    command = [*compiler, "-std=c++20", f"-I{root}", "-w", "-fsyntax-only", "-x", "c++", "-"]
    done = subprocess.run(command, input=text, capture_output=True, text=True)
    return "".join(done.stderr.splitlines(True)[:5]) if done.returncode else ""


def not_compiled(mutations, root, compiler, jobs):
    """Returns (name, compiler messages) of mutations that do not compile. A file is compiled once with all of
    its mutations, and with each separately only if that fails. Templates of a header are checked as far as
    they need no parameter."""
    of_file = {}
    for mutation in mutations:
        of_file.setdefault(mutation[1], []).append(mutation)

    def faults(file):
        together = errors_of(of_file[file], file, root, compiler)
        if together == "":
            return []
        apart = [(mutation[0], errors_of([mutation], file, root, compiler)) for mutation in of_file[file]]
        return [(name, said) for name, said in apart if said] or ([(file, together)] if together else [])

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        return [fault for found in pool.map(faults, of_file) for fault in found]


def copy_of_source(folder):
    os.makedirs(folder, exist_ok=True)
    files = subprocess.run(
        ["git", "ls-files", "-z"], cwd=SOURCE, check=True, capture_output=True, text=True
    ).stdout.split("\0")
    for file in filter(None, files):
        target = os.path.join(folder, file)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        # Copies only files that differ, so that a second call builds little.
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


def programs(folder, name):
    """Returns the programs of these tests: the one of that name, or for engine_tests one per room."""
    binaries = os.path.join(folder, "build/release/bin")
    if name != "engine_tests":
        return [os.path.join(binaries, name)]
    found = glob.glob(os.path.join(binaries, "engine_*_tests"))
    return sorted(path for path in found if not path.endswith("engine_bench_tests"))


def failed_tests(folder, name, arguments):
    """Returns the names of failing tests; exits if a program ends otherwise."""
    return sorted(set().union(*(failed_in(folder, program, arguments) for program in programs(folder, name))))


def failed_in(folder, program, arguments):
    try:
        done = subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True, timeout=1800)
    except subprocess.TimeoutExpired:
        return ["does not end"]
    if done.returncode < 0:
        return [f"{CRASH} {-done.returncode}"]
    names = re.findall(r"^\[  FAILED  \] ([\w./]+)(?:, |$| \()", done.stdout, re.M)
    return sorted(set(names)) or ([] if done.returncode == 0 else [f"exit {done.returncode}"])


def who_notices(folder):
    binaries = os.path.join(folder, "build/release/bin")
    noticed = []
    for study in STUDIES:
        try:
            done = subprocess.run(
                ["/usr/bin/python3", os.path.join(folder, "results", study, "study.py"), binaries, "--quick"],
                capture_output=True,
                timeout=1800,
            )
        except subprocess.TimeoutExpired:
            noticed.append(f"study {study} (does not end)")
            continue
        if done.returncode != 0:
            noticed.append(f"study {study}")
    for program, arguments in (("engine_tests", []), ("physics_tests", ["--gtest_filter=-PairDensity*"])):
        names = failed_tests(folder, program, arguments)
        if names:
            more = f" and {len(names) - 3} more" if len(names) > 3 else ""
            noticed.append(f"{program}: {', '.join(names[:3])}{more}")
    return noticed


def who_of_the_named(folder, names):
    """Returns those of the tests (program:test) that fail; exits if a program lacks a test."""
    noticed = []
    for program in sorted({name.split(":")[0] for name in names}):
        tests = [name.split(":")[1] for name in names if name.startswith(program + ":")]
        for test in tests:
            listed = [
                subprocess.run(
                    [path, f"--gtest_filter={test}", "--gtest_list_tests"], capture_output=True, text=True, check=True
                ).stdout
                for path in programs(folder, program)
            ]
            if not any("\n  " in text for text in listed):
                sys.exit(f"{program} has no {test}")
        chosen = [f"--gtest_filter={':'.join(tests)}"]
        noticed += [f"{program}: {name}" for name in failed_tests(folder, program, chosen)]
    return noticed


def git(*arguments):
    return subprocess.run(["git", *arguments], cwd=SOURCE, check=True, capture_output=True, text=True).stdout.strip()


def commit_of_source():
    return git("rev-parse", "--short=7", "HEAD") + (
        " with changes" if git("status", "--porcelain", "--untracked-files=no") else ""
    )


def trees():
    """Returns the hashes of what fine mutations depend on, which commits on other subjects do not change."""
    parts = ("engine", "contract", "schema", "tests/engine", "tests/physics", "tests/CMakeLists.txt")
    parts += ("cmake", "CMakeLists.txt", "CMakePresets.json")
    return " ".join(git("rev-parse", "--short=7", f"HEAD:{part}") for part in parts) + (
        " with changes" if git("status", "--porcelain", *parts) else ""
    )


class Known:
    """The failing tests by mutation, kept between calls for one commit without changes."""

    def __init__(self, folder, commit, file):
        os.makedirs(folder, exist_ok=True)
        self.path, self.commit, self.noticed = os.path.join(folder, file), commit, {}
        self.lasting = "changes" not in commit
        if self.lasting and os.path.exists(self.path):
            with open(self.path) as f:
                stored = json.load(f)
            self.noticed = stored["noticed"] if stored["commit"] == commit else {}

    @staticmethod
    def key(mutation):
        """Returns a key that changes with the text of the mutation."""
        return f"{mutation[0]} {hashlib.sha256(repr(mutation).encode()).hexdigest()[:12]}"

    def add(self, mutation, noticed):
        self.noticed[self.key(mutation)] = noticed
        if self.lasting:
            with open(self.path, "w") as f:
                json.dump({"commit": self.commit, "noticed": self.noticed}, f, indent=1)


MARK = "## Fine mistakes\n"


def halves():
    """Returns the coarse half of mutations.md, and the rows of the fine half by name."""
    with open(os.path.join(HERE, "mutations.md")) as f:
        before, _, after = f.read().partition(MARK)
    rows = [line for line in after.splitlines() if line.startswith("| ") and not line.startswith("| broken")]
    return before.rstrip("\n"), {row.split(" | ")[0].removeprefix("| "): row for row in rows}


def write_halves(before, rows):
    names = ["nothing", *(mutation[0] for mutation in NAMED)]
    with open(os.path.join(HERE, "mutations.md"), "w") as f:
        f.write(
            f"{before}\n\n{MARK}\n`mutations.py --named` tries each with the one test of seconds that must notice it. "
            "Each row is made separately (`--only\n"
            "WORD`); its last column is the tree of `engine/` at that time (`git rev-parse HEAD:engine`).\n\n"
            "| broken | noticed by | engine |\n|---|---|---|\n"
        )
        f.write("".join(rows[name] + "\n" for name in names if name in rows))


def coarse(folder, jobs, mutation):
    build(folder, jobs)
    return who_notices(folder)


def fine(folder, jobs, mutation):
    """Returns the failing tests of a fine mutation; unchanged source runs the tests of all."""
    names = [mutation[4]] if mutation[1] else mutation[4]
    build(folder, jobs, sorted({name.split(":")[0] for name in names}))
    return who_of_the_named(folder, names)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "folder", nargs="?", type=os.path.abspath, help="of the copy; kept, so that a second call goes faster"
    )
    parser.add_argument("--check", action="store_true")
    parser.add_argument(
        "--compiler",
        metavar="COMMAND",
        type=shlex.split,
        default="c++ -isystem/usr/include/eigen3",
        help="of --check, with the folders of headers that it does not know",
    )
    parser.add_argument("--named", action="store_true", help="the fine ones, each before its own test")
    parser.add_argument("--only", default="", help="mutations whose name has this in it")
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    for mutation in (*COARSE, *NAMED):
        replaced(mutation, SOURCE)
    if arguments.check:
        faults = not_compiled([*COARSE, *NAMED], SOURCE, arguments.compiler, arguments.jobs)
        print("".join(f"{name}: does not compile:\n{said}" for name, said in faults), end="")
        print(f"{len(COARSE) + len(NAMED)} mutations apply, {len(faults)} of them do not compile")
        return 1 if faults else 0
    if not arguments.folder:
        parser.error("needs a folder")
    chosen, who = (NAMED, fine) if arguments.named else (COARSE, coarse)
    commit, tree = commit_of_source(), trees()
    known = Known(
        arguments.folder,
        tree if arguments.named else commit,
        "noticed-named.json" if arguments.named else "noticed.json",
    )
    before, rows = halves()
    lines = []
    missed = 0
    # Unchanged source comes first, with the tests of all mutations.
    for mutation in [("nothing", None, None, None, sorted({m[4] for m in NAMED})), *chosen]:
        if arguments.only not in mutation[0]:
            continue
        if known.key(mutation) not in known.noticed:
            copy_of_source(arguments.folder)
            if mutation[1]:
                path, text = replaced(mutation, arguments.folder)
                with open(path, "w") as f:
                    f.write(text)
            known.add(mutation, who(arguments.folder, arguments.jobs, mutation))
        noticed = known.noticed[known.key(mutation)]
        missed += bool(mutation[1]) != bool(noticed) or any(CRASH in who for who in noticed)
        lines.append(
            f"| {mutation[0]} | {'; '.join(noticed) or ('no test' if mutation[1] else 'no test, as it should be')} |"
        )
        print(lines[-1], flush=True)
        if arguments.named and known.lasting:
            rows[mutation[0]] = f"{lines[-1]} {tree.split()[0]} |"
            write_halves(before, rows)
    if not arguments.named and not arguments.only:
        write_halves(
            "# Which tests notice broken physics\n\nOne line of the engine is broken at a time, in a copy of the "
            "source."
            "\n\n## Coarse mistakes\n\n`mutations.py` tries each with the quick forms of the studies and with all "
            "tests of the engine and of the physics.\nNames of tests are those of the commit.\n"
            f"Commit {commit}, {processor()}, {datetime.date.today().isoformat()}.\n\n"
            "| broken | noticed by |\n|---|---|\n" + "\n".join(lines),
            rows,
        )
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
