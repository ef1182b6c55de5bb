"""The viscosity at rest, Pe → 0."""
from pathlib import Path

from studies.tables import entries, number, read_rows

RESULTS = Path(__file__).resolve().parents[1]
SLOWEST = 0.046  # the lowest Peclet number that slow shear knows to a few per cent
SLOW_SHEAR = f"slow shear, Pe = {SLOWEST:g}"


SEEDS = 31  # of a table that does not say how many: 30 degrees of freedom, as rows have


def rows_at_rest():
    """By volume fraction: `viscosity` with 1 + 2.5 phi and `pairs` without, with their standard errors, and seeds; and
    where they are from. From the study at-rest if it has been made (its table: fraction, count, viscosity with 1 + 2.5
    phi and viscosity_error, `by` momentum where it has several ways; the largest count of each fraction), else from
    slow shear, as flow-curve has it."""
    exact = RESULTS / "at-rest" / "table.csv"
    if not exact.exists():
        table = read_rows(RESULTS / "flow-curve" / "table.csv")
        rows = [r for r in table if (r["method"], r["count"], r["peclet"]) == ("implicit", 250, SLOWEST)]
        return {r["fraction"]: r for r in rows}, SLOW_SHEAR
    found = {}
    for row in sorted(read_rows(exact), key=lambda r: r["count"]):
        if row.get("by", "momentum") == "momentum":
            value, error = number(row, "viscosity")
            pairs = entries("pairs", (value - 1 - 2.5 * row["fraction"], error))
            found[row["fraction"]] = {"seeds": SEEDS} | row | pairs
    return found, "linear response"
