"""Extracts the commands of a LAMMPS input script, without comments, blank lines and continuation lines.

Follows Input::file() and Input::parse() of LAMMPS, in this order:

- A line whose last printable character is & continues on the next line, even if it is a comment.
- A line with an odd number of triple quotes continues on the next line; the line break stays.
- A # outside quotes ends the command.
"""

BLANK = b" \t\n\v\f\r"
TRIPLE = b'"""'


def whole_commands(content):
    """Yields the commands of a script (bytes), each joined from its lines, with comments."""
    command = b""
    for line in content.split(b"\n"):
        command += line + b"\n"
        bare = command.rstrip(BLANK)
        if bare.endswith(b"&"):
            command = bare[:-1]
        elif bare.count(TRIPLE) % 2 == 0:
            yield bare
            command = b""
    if command:
        yield command.rstrip(BLANK)


def without_comment(command):
    """Returns a command without its comment: the text before the first # outside quotes."""
    quote, place = b"", 0
    while place < len(command):
        if not quote and command[place : place + 1] == b"#":
            return command[:place]
        here = TRIPLE if command.startswith(TRIPLE, place) and quote in (b"", TRIPLE) else command[place : place + 1]
        if not quote and here in (TRIPLE, b'"', b"'"):
            quote = here
        elif here == quote:
            quote = b""
        place += len(here)
    return command


def commands(content):
    """Returns the commands of a script (bytes), one a line, without comments and blank lines."""
    stripped = (without_comment(command).strip(BLANK) for command in whole_commands(content))
    return b"".join(command + b"\n" for command in stripped if command)
