"""Peclet's frames over one end of a socket pair, and files that appear whole or not at all (schema/README.md,
"Frames")."""
import json
import os
import select
import socket
import struct

MAGIC = b"PCF1"
LARGEST_FRAME = 64 << 20


class Gone(Exception):
    """The runner has closed its end: nobody listens any more."""


class FrameError(Exception):
    """What came is no frame; the stream is of no use after that."""


class Channel:
    """Whole messages in both directions. Does not own the descriptor."""

    def __init__(self, descriptor):
        self.socket = socket.socket(fileno=os.dup(descriptor))
        self.received = b""

    def fileno(self):
        return self.socket.fileno()

    def send(self, message):
        payload = json.dumps(message, allow_nan=False).encode()
        try:
            self.socket.sendall(MAGIC + struct.pack("<I", len(payload)) + payload)
        except (BrokenPipeError, ConnectionResetError):
            raise Gone from None

    def receive(self, patience=None):
        """The next message; None when there is none within `patience` seconds (None waits for ever). Raises Gone,
        FrameError."""
        while (message := self.next_message()) is None:
            if not select.select([self.socket], [], [], patience)[0]:
                return None
            try:
                part = self.socket.recv(65536)
            except ConnectionResetError:
                part = b""
            if not part:
                raise Gone
            self.received += part
        return message

    def next_message(self):
        if not MAGIC.startswith(self.received[:4]):
            raise FrameError("the runner does not speak PCF1")
        if len(self.received) < 8:
            return None
        length = struct.unpack("<I", self.received[4:8])[0]
        if length > LARGEST_FRAME:
            raise FrameError(f"a frame announces {length} bytes")
        if len(self.received) < 8 + length:
            return None
        payload, self.received = self.received[8 : 8 + length], self.received[8 + length :]
        return json.loads(payload)


def write_durably(path, content):
    """Replaces the file at `path` by `content`, so that also after a power cut it is the old one or the new one."""
    # The runner removes what a dead process has left under such a name: NAME.PROCESS.COUNT.tmp
    temporary = f"{path}.{os.getpid()}.0.tmp"
    with open(temporary, "wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())
    os.rename(temporary, path)
    folder = os.open(os.path.dirname(path) or ".", os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)
