"""Hours of processor time: what was planned before anything had run, and what it took."""
from pathlib import Path


class Hours:
    """Of campaigns of which `peclet plan` knew nothing."""

    def __init__(self, program, seeds):
        self._program, self._seeds = program, seeds
        self.planned, self.taken = 0.0, 0.0

    def plan(self, name, scene, settings, observable="relative_viscosity"):
        """Of a campaign of its own, which is never run. Kept, since planning takes some seconds."""
        kept = Path(self._program.folder) / f"{name}.planned"
        if not kept.exists():
            self._program.write(f"plan-{name}", scene, settings, self._seeds, observable)
            kept.write_text(str(self._program.asked("plan", f"plan-{name}")["cpu_hours_maximum"]))
        self.planned += float(kept.read_text())

    def add(self, points):
        """What the points of an export took."""
        self.taken += sum(r["cost"]["cpu_seconds"] for point in points for r in point["realisations"]) / 3600

    def numbers(self):
        """As write_numbers() takes them."""
        return {"planned": (self.planned, 0.0, 0), "taken": (self.taken, 0.0, 0)}
