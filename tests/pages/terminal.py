"""The screen of a program in a terminal of a given size, as cells and as HTML to be photographed.

    screen = watched(["peclet", "watch", "curve.json"], rows=24, columns=80, seconds=5)
    print(screen.text())

Knows the output of the programs here: text, returns, positions, erasing, bold, faint and the sixteen colours.
"""

import fcntl
import html
import os
import pty
import re
import select
import signal
import struct
import termios
import time

SEQUENCE = re.compile(r"\x1b\[([?0-9;]*)([A-Za-z])")
COLOURS = ["#1b1b1b", "#c4341c", "#2a7a3f", "#a66f00", "#1f5fa8", "#8f3f8f", "#1b7f86", "#d8d8d8"]


class Screen:
    def __init__(self, rows, columns):
        self.rows, self.columns, self.unread = rows, columns, ""
        self.row = self.column = 0
        self.style = ()
        self.cells = [self.blank() for _ in range(rows)]

    def blank(self):
        return [(" ", ())] * self.columns

    def feed(self, text):
        text, self.unread = self.unread + text, ""
        place = 0
        while place < len(text):
            if text[place] == "\x1b":
                found = SEQUENCE.match(text, place)
                if not found:
                    if len(text) - place > 20:
                        raise ValueError(f"a sequence that is not known: {text[place:place + 20]!r}")
                    self.unread = text[place:]  # the sequence is incomplete
                    return
                self.obey(found[1], found[2])
                place = found.end()
            else:
                self.put(text[place])
                place += 1

    def put(self, character):
        if character == "\r":
            self.column = 0
        elif character == "\n":
            self.row += 1
        elif character >= " ":
            if self.column == self.columns:
                self.row, self.column = self.row + 1, 0
            self.scroll()
            self.cells[self.row][self.column] = (character, self.style)
            self.column += 1
        self.scroll()

    def scroll(self):
        while self.row >= self.rows:
            self.cells = self.cells[1:] + [self.blank()]
            self.row -= 1

    def obey(self, numbers, letter):
        if numbers.startswith("?"):
            return  # cursor visibility or alternate screen, not drawn
        values = [int(number or 0) for number in numbers.split(";")]
        if letter == "H":
            self.row, self.column = (max(1, value) - 1 for value in (values + [1])[:2])
        elif letter == "K":
            self.cells[self.row][self.column :] = self.blank()[self.column :]
        elif letter == "J":
            first = self.row + 1 if values[0] == 0 else 0
            if values[0] == 0:
                self.cells[self.row][self.column :] = self.blank()[self.column :]
            for row in range(first, self.rows):
                self.cells[row] = self.blank()
        elif letter == "m":
            for value in values:
                self.style = () if value == 0 else (*self.style, value)
        else:
            raise ValueError(f"a sequence that is not known: {numbers}{letter}")

    def text(self):
        """Returns the lines down to the last that is not empty."""
        lines = ["".join(character for character, _ in row).rstrip() for row in self.cells]
        while lines and not lines[-1]:
            lines.pop()
        return "\n".join(lines)

    def html(self):
        lines = self.text().split("\n")
        drawn = ["".join(span(*cell) for cell in row) for row in self.cells[: len(lines)]]
        return (
            '<!DOCTYPE html><meta charset="utf-8"><style>body { margin: 0; background: #fff; } pre { margin: 0;'
            " display: inline-block; padding: 12px 16px; background: #f7f7f5; color: #1b1b1b;"
            " font: 14px/1.35 'DejaVu Sans Mono', monospace; }</style>"
            f'<pre style="width: {self.columns}ch">' + "\n".join(drawn) + "</pre>"
        )


def span(character, style):
    rules = []
    for value in style:
        if value == 1:
            rules.append("font-weight: bold")
        elif value == 2:
            rules.append("opacity: 0.6")
        elif 30 <= value <= 37 or 90 <= value <= 97:
            rules.append(f"color: {COLOURS[value % 10]}")
    text = html.escape(character)
    return f'<span style="{"; ".join(rules)}">{text}</span>' if rules else text


def watched(command, rows, columns, seconds, **how):
    """Returns the screen of `command` at its end, or after `seconds` seconds, when it gets a Ctrl-C."""
    process, terminal = pty.fork()
    if process == 0:
        try:
            fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
            os.chdir(how.get("cwd", "."))
            os.execvpe(command[0], command, {**how.get("env", os.environ), "TERM": "xterm-256color"})
        finally:
            os._exit(127)
    screen, until, pending = Screen(rows, columns), time.monotonic() + seconds, b""
    while time.monotonic() < until:
        if not select.select([terminal], [], [], 0.1)[0]:
            continue
        try:
            pending += os.read(terminal, 65536)
        except OSError:  # the program has ended
            break
        whole = pending.decode("utf-8", "ignore")
        pending = pending[len(whole.encode()) :]
        screen.feed(whole)
    else:
        os.killpg(process, signal.SIGINT)
    os.waitpid(process, 0)
    os.close(terminal)
    return screen
