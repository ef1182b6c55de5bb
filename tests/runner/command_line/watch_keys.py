#!/usr/bin/python3
"""watch_keys.py PECLET FAKE_ENGINE

Keys typed while `peclet watch` shows its table are not echoed, and the echo is back afterwards.
"""
import json
import os
import pty
import signal
import sys
import tempfile
import termios
import time


def shown(terminal, seconds):
    """Returns the output on the terminal within some seconds."""
    os.set_blocking(terminal, False)
    text, end = b"", time.monotonic() + seconds
    while time.monotonic() < end:
        try:
            text += os.read(terminal, 65536)
        except BlockingIOError:
            time.sleep(0.05)
        except OSError:
            break
    return text.decode()


def echoes(terminal):
    return bool(termios.tcgetattr(terminal)[3] & termios.ECHO)


def main(peclet, engine):
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "night.json")
        with open(file, "w") as campaign:
            json.dump(
                {
                    "name": "night",
                    "scene": {"volume_fraction": 0.5},
                    "target": {"relative_tolerance": 0.2},
                    "realisations": {"minimum": 8, "maximum": 40},
                    "engine": [engine],
                },
                campaign,
            )
        terminal, other_end = pty.openpty()
        process = os.fork()
        if process == 0:
            os.setsid()
            os.close(terminal)
            for descriptor in (0, 1, 2):
                os.dup2(other_end, descriptor)
            os.close(os.open(os.ttyname(other_end), os.O_RDWR))  # makes it the controlling terminal
            os.execv(peclet, [peclet, "watch", file])
        end = time.monotonic() + 30
        while echoes(other_end) and time.monotonic() < end:
            time.sleep(0.05)
        table = shown(terminal, 2)
        assert "night: nothing has been run yet" in table, repr(table)
        os.write(terminal, b"?~|")
        after = shown(terminal, 2)
        assert not set("?~|") & set(after), repr(after)
        os.kill(process, signal.SIGINT)
        os.waitpid(process, 0)
        assert echoes(other_end), "the terminal was left without an echo"
    print("keys are not shown")


if __name__ == "__main__":
    main(*sys.argv[1:])
