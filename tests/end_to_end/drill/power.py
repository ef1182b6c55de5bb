"""A power cut: takes back changes that the shim's journal (shim/journal.h) lists as not synchronised.

The disk then has any mixture of the state at the last fsync and of later writes: per file by sectors, per
folder its first changes without the later ones. By the strict reading of POSIX, a file's fsync does not save
its name; only that of its folder does.
"""
import contextlib
import os
import re

SECTOR = 512


class Record:
    def __init__(self, line, data):
        words = line.split(" ", 6)
        self.sequence, self.kind = int(words[0]), words[1]
        self.inode, self.offset, self.size = (int(word) for word in words[2:5])
        self.paths = words[6].split(" -> ")
        self.data = data


def read_journal(folder):
    records = []
    for name in os.listdir(folder):
        if name == "kept":
            continue
        with open(os.path.join(folder, name), "rb") as f:
            content = f.read()
        place = 0
        while place < len(content):
            # A process killed while recording a change did not make it.
            end = content.find(b"\n", place)
            if end < 0:
                break
            line = content[place:end].decode()
            count = int(line.split(" ", 6)[5])
            records.append(Record(line, content[end + 1 : end + 1 + count]))
            place = end + 1 + count
    return sorted(records, key=lambda record: record.sequence)


def acknowledged_spool(records):
    """Returns the spool files whose names were durable at the cut: (prefix of the hash, seed)."""
    waiting, safe = set(), set()
    for record in records:
        target = record.paths[-1]
        found = re.search(r"/spool/([0-9a-f]{16})-(\d+)-\d+\.json$", target)
        if record.kind == "rename" and found:
            waiting.add((found[1], int(found[2])))
        if record.kind == "sync-folder" and target.endswith("/spool"):
            safe |= waiting
            waiting.clear()
    return safe


def undo(image, record):
    """Restores the file's content before one change."""
    if record.kind == "truncate":
        if len(image) < record.size:  # a later record, already undone, made it grow
            image.extend(bytes(record.size - len(image)))
        image[record.offset : record.size] = record.data
    else:
        image[record.offset : record.offset + len(record.data)] = record.data
        del image[record.size :]
    return image


def mixture(old, new, chance):
    """Returns a file of old and new sectors, with the size of one of them."""
    size = chance.choice((len(old), len(new)))
    mixed = bytearray(size)
    for begin in range(0, size, SECTOR):
        source = chance.choice((old, new))[begin : begin + SECTOR]
        mixed[begin : begin + len(source)] = source[: size - begin]
    return mixed


def files_below(folder):
    for root, _, names in os.walk(folder):
        for name in names:
            yield os.path.join(root, name)


def cut(campaign, journal, chance):
    """Takes back a random part of the changes that were not synchronised. Returns the numbers of such changes
    of contents and of names, and notes in the campaign what was acknowledged."""
    records = read_journal(journal)
    contents = spoil_contents(campaign, journal, records, chance)
    names = spoil_names(journal, records, chance)
    return contents, names


def spoil_contents(campaign, journal, records, chance):
    unsynchronised = {}
    for record in records:
        if record.kind in ("write", "truncate"):
            unsynchronised.setdefault(record.inode, []).append(record)
        elif record.kind == "sync":
            unsynchronised.pop(record.inode, None)
    places = {}
    for path in [*files_below(campaign.data), *files_below(os.path.join(journal, "kept"))]:
        places.setdefault(os.stat(path).st_ino, path)
    count = 0
    for inode, changes in unsynchronised.items():
        if inode not in places:
            continue
        with open(places[inode], "rb") as f:
            new = f.read()
        old = bytearray(new)
        for record in reversed(changes):
            old = undo(old, record)
        mode = chance.choice(("dropped", "torn", "torn", "kept"))
        if mode != "kept":
            with open(places[inode], "r+b") as f:
                image = old if mode == "dropped" else mixture(old, new, chance)
                f.write(image)
                f.truncate(len(image))
        count += len(changes)
    return count


def spoil_names(journal, records, chance):
    by_folder = {}
    for record in records:
        if record.kind in ("create", "rename", "remove"):
            by_folder.setdefault(os.path.dirname(record.paths[-1]), []).append(record)
        elif record.kind == "sync-folder":
            by_folder.pop(record.paths[0], None)
    count = 0
    taken_back = []
    for changes in by_folder.values():
        taken_back += changes[chance.randint(0, len(changes)) :]
        count += len(changes)
    # Newest first, over all folders: a change may depend on one in another folder.
    for record in sorted(taken_back, key=lambda each: -each.sequence):
        kept = os.path.join(journal, "kept", str(record.sequence))
        with contextlib.suppress(FileNotFoundError):
            if record.kind == "create":
                os.unlink(record.paths[0])
            elif record.kind == "rename":
                os.rename(record.paths[1], record.paths[0])
        if record.kind != "create" and os.path.exists(kept) and not os.path.exists(record.paths[-1]):
            os.link(kept, record.paths[-1])
    return count
