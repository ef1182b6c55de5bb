"""What LAMMPS reads of an input script: its commands, without comments, blank lines and the way they are broken into
lines.

As Input::file() and Input::parse() of LAMMPS do it, in this order: a line whose last printable character is & goes on
with the next one, also when it is a comment; so does one with an odd number of triple quotes, whose line breaks stay.
Then a # outside quotes ends the command."""

BLANK = b" \t\n\v\f\r"
TRIPLE = b'"""'


def whole_commands(content):
    """Lines with those that continue them."""
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
    """The bytes that make the script what it is: one command a line."""
    stripped = (without_comment(command).strip(BLANK) for command in whole_commands(content))
    return b"".join(command + b"\n" for command in stripped if command)
