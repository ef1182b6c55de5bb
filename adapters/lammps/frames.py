"""Sends and receives Peclet's frames (schema/README.md, "Frames"), and writes files durably."""
import json
import os
import select
import socket
import struct

MAGIC = b"PCF1"
LARGEST_FRAME = 64 << 20


class Gone(Exception):
    """The runner has closed its end of the connection."""


class FrameError(Exception):
    """The received bytes are not a frame; the stream is then unusable."""


class Channel:
    """Sends and receives whole messages over a socket. Does not own the descriptor."""

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
        """Returns the next message, or None if none is complete within `patience` [s]; None waits without limit.

        Raises Gone if the runner has closed its end, FrameError if the bytes are not a frame.
        """
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
    """Replaces the file at `path` by `content` (bytes); after a power cut it is the old file or the new one."""
    # The runner removes files that a dead process has left under names NAME.PROCESS.COUNT.tmp.
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
