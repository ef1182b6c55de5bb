"""The transcript of the mistakes as a page."""
import re
import textwrap

HEAD = """# At two in the morning

What a tired person does wrong, and what `peclet` answers: what happened, what was kept, and the next command. Written
by `tests/end_to_end/at_two_in_the_morning.py BIN --page tests/end_to_end/MISTAKES.md`, which does all of this with real
processes and checks it: exit codes, the phrases that matter, in the cases that count results that none is lost, and in
many that the command that the answer names works as it stands. Folders are shortened to `~`, long answers and the
legends of tables cut, long lines of answers folded, times and process numbers replaced; `fake_engine` is the tests'
engine without physics.
"""
WIDEST = 120  # characters per line
LONGEST = 12  # lines per answer


# The end of every table.
LEGEND = re.compile(r"^(all seeds: mean|95 % interval at the last).*\n", re.MULTILINE)


def folded(line, indent=""):
    """Returns the line, or its parts of allowed width, the later ones indented; words stay whole."""
    if len(line) <= WIDEST:
        return [line]
    return textwrap.wrap(line, WIDEST, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)


def shortened(text, night):
    text = text.replace(night.folder, "~").replace(night.programs, "BIN")
    text = LEGEND.sub("", text).replace("\n\n", "\n")
    text = re.sub(r"process \d+", "process 4711", text)
    text = re.sub(r"kill \d+", "kill 4711", text)
    text = re.sub(r"(?<!\d)\d\d:\d\d:\d\d", "02:00:00", text)
    lines = text.rstrip("\n").splitlines()
    if len(lines) > LONGEST:
        lines = lines[: LONGEST - 1] + [f"... ({len(lines) - LONGEST + 1} lines)"]
    return lines


def of_case(night):
    lines, block = [], []

    def close():
        if block:
            lines.extend(["```", *block, "```", ""])
            block.clear()

    for kind, *about in night.page:
        if kind == "types":
            block.extend(f"$ {line}" for line in shortened(about[0], night))
        elif kind == "answer":
            block.extend(part for line in shortened(about[0], night) for part in folded(line, "    "))
        elif kind == "code":
            if about[0] != 0:
                block.append(f"[exit code {about[0]}]")
        else:
            close()
            lines.extend([*folded(remark(kind, about)), ""])
    close()
    return lines


def remark(kind, about):
    if kind == "kept":
        kept, gone = about
        return (
            f"*{kept} results before, {kept} of them now.*"
            if not gone
            else f"*Of {kept + gone} results {kept} are kept.*"
        )
    return "*The export is that of an undisturbed campaign, byte for byte.*" if kind == "same" else about[0]


def page(told):
    lines = [HEAD]
    number = 0
    for chapter, cases in told:
        lines.append(f"## {chapter}\n")
        for title, night in cases:
            number += 1
            lines.append(f"### {number}. {title}\n")
            lines.extend(of_case(night))
    return "\n".join(lines).rstrip("\n") + "\n"
