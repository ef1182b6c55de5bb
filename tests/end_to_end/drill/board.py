"""Faults made by the preloaded shim (shim/plan.h): at which call of which process, and with what result."""
import mmap
import os
import struct
import time

LAYOUT = struct.Struct("<5q256s")  # calls, struck, off, sequence, process, what


class Board:
    """A page of memory that the drill shares with the processes it disturbs."""

    def __init__(self, folder):
        self.path = os.path.join(folder, "board")
        with open(self.path, "wb") as f:
            f.write(bytes(4096))
        with open(self.path, "r+b") as f:
            self.page = mmap.mmap(f.fileno(), 4096)

    def _field(self, index):
        return struct.unpack_from("<q", self.page, 8 * index)[0]

    calls = property(lambda self: self._field(0))
    struck = property(lambda self: self._field(1))
    process = property(lambda self: self._field(4))
    what = property(lambda self: self.page[40:296].split(b"\0")[0].decode(errors="replace"))

    def wait(self, process):
        """Waits until a call was hit, or the process has ended."""
        while not self.struck and process.poll() is None:
            time.sleep(0.002)

    def switch_off(self):
        """Ends the faults."""
        struct.pack_into("<q", self.page, 16, 1)

    def environment(
        self, shim, role="any", call="any", number=0, action="kill", path=".peclet/,socket", times=1, journal=None
    ):
        plan = f"role={role} call={call} number={number} action={action} path={path} for={times}"
        variables = {"LD_PRELOAD": shim, "PECLET_FAULT_BOARD": self.path, "PECLET_FAULT_PLAN": plan}
        if journal:
            os.makedirs(os.path.join(journal, "kept"), exist_ok=True)
            variables["PECLET_FAULT_JOURNAL"] = journal
        return variables
