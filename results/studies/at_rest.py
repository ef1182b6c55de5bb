"""The viscosity at rest, Pe → 0."""
from pathlib import Path

from studies.tables import entries, number, read_rows

RESULTS = Path(__file__).resolve().parents[1]
SLOWEST = 0.046  # the lowest Peclet number that slow shear knows to a few per cent
SLOW_SHEAR = f"slow shear, Pe = {SLOWEST:g}"


def slow_rows():
    """Of the study flow-curve, by volume fraction."""
    table = read_rows(RESULTS / "flow-curve" / "table.csv")
    rows = [r for r in table if (r["method"], r["count"], r["peclet"]) == ("implicit", 250, SLOWEST)]
    return {r["fraction"]: r for r in rows}


def exact_rows():
    """Of the study at-rest: by momentum, with its usual step; the best known one of each volume fraction."""
    found = {}
    table = read_rows(RESULTS / "at-rest" / "table.csv")
    for row in sorted(table, key=lambda r: -r["viscosity_error"]):
        if (row["by"], row["step"]) == ("momentum", "automatic"):
            value, error = number(row, "viscosity")
            found[row["fraction"]] = row | entries("pairs", (value - 1 - 2.5 * row["fraction"], error))
    return found


def rows_at_rest():
    """By volume fraction: `viscosity` with 1 + 2.5 phi and `pairs` without, with their standard errors, and seeds; and
    where they are from: linear response, and slow shear at volume fractions that have no other row."""
    slow, exact = slow_rows(), exact_rows()
    rest = [f for f in slow if f not in exact]
    others = f"; φ = {', '.join(f'{f:g}' for f in rest)}: {SLOW_SHEAR}" if rest else ""
    return slow | exact, f"linear response{others}"
