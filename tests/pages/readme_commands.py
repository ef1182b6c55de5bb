#!/usr/bin/python3
"""readme_commands.py BIN

Runs the commands of README.md and compares their output with the page. The blocks marked ```bash run one
after another in one shell, in an empty home, with BIN in place of build/release/bin. Tables are compared in
headings, legends, points and verdicts. A viscosity must agree within the sum of both half-widths, because
last digits differ between instruction sets.
"""
import os
import re
import subprocess
import sys
import tempfile

SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
ESTIMATE = re.compile(r"\s(\S+) ± (\S+) \(\S+ %\)")


def readme():
    with open(os.path.join(SOURCE, "README.md"), encoding="utf-8") as file:
        return file.read()


def blocks(page, language):
    return [
        text
        for found, text in re.findall(r"^```(\w*)\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
        if found == language
    ]


def shown(page, campaign):
    """Returns the table on the page for a campaign whose points are all decided."""
    tables = [text for text in blocks(page, "") if text.startswith(f"{campaign}: ") and " open" not in text]
    assert len(tables) == 1, f"{len(tables)} tables of {campaign} in README.md"
    return tables[0]


def rows(table):
    """Returns estimate, half-width and verdict by point."""
    found = {}
    for line in table.splitlines():
        estimate = ESTIMATE.search(line)
        if estimate:
            found[line.split()[0]] = (float(estimate[1]), float(estimate[2]), line.split()[-1])
    return found


def fixed_text(table):
    """Returns headings, legend and the number of points, without column widths and counts of seeds."""
    return [
        line.split()
        for line in table.splitlines()
        if not ESTIMATE.search(line) and not re.match(r"\d+ seeds ended|predictions:", line)
    ]


def compare(page, printed, whole):
    """Compares the tables; `whole` if the page shows all that is printed."""
    mine, its = rows(page), rows(printed)
    assert mine and mine.keys() == its.keys(), f"points: README.md has {list(mine)}, the program {list(its)}"
    for point, (estimate, half_width, verdict) in mine.items():
        other, other_half_width, other_verdict = its[point]
        assert verdict == other_verdict, f"{point}: {verdict} in README.md, {other_verdict} now"
        assert abs(estimate - other) <= half_width + other_half_width, f"{point}: {estimate} in README.md, {other} now"
    expected, found = fixed_text(page), fixed_text(printed)
    assert expected == (
        found if whole else found[: len(expected)]
    ), f"README.md shows\n{page}\nand the program prints\n{printed}"


def shell(script, home, folder):
    # Debian's python3, which has matplotlib, comes first.
    environment = {**os.environ, "HOME": home, "PATH": f"/usr/bin:{os.environ['PATH']}"}
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", script],
        cwd=folder,
        env=environment,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert done.returncode == 0, f"exit code {done.returncode} of\n{script}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def main():
    programs = os.path.abspath(sys.argv[1])
    page = readme()
    with tempfile.TemporaryDirectory() as home:
        source = os.path.join(home, "source")
        os.makedirs(os.path.join(source, "build", "release"))
        os.symlink(programs, os.path.join(source, "build", "release", "bin"))

        tutorial = blocks(page, "bash")
        printed = shell("\n".join(f"{block}\necho '== end of block'" for block in tutorial), home, source).split(
            "== end of block\n"
        )
        of_campaign = next(text for block, text in zip(tutorial, printed) if "peclet run" in block)
        compare(shown(page, "friction"), of_campaign[of_campaign.rindex("friction: relative_viscosity") :], whole=False)
        print(f"{len(tutorial)} blocks of commands, and the table of friction.json")

        demo = f"{programs}/peclet run {SOURCE}/results/demo/campaign.json --directory {home}/demo.peclet --quiet"
        compare(shown(page, "demo"), shell(demo, home, home), whole=True)
        print("the table of the demonstration")


if __name__ == "__main__":
    main()
