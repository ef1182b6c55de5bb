"""Folders for LAMMPS to run in, each locked by the process that uses it, so that those of the killed can be told and
removed."""
import contextlib
import fcntl
import os
import shutil
import tempfile

PREFIX = "peclet-lammps-"


def lock(path):
    """A descriptor that holds the folder's lock until it is closed, also by the process's death; None when another one
    has it."""
    descriptor = os.open(path, os.O_RDONLY | os.O_DIRECTORY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(descriptor)
        return None
    return descriptor


@contextlib.contextmanager
def folder_with(files):
    """A fresh folder with links to `files`, which is removed at the end."""
    path = tempfile.mkdtemp(prefix="new-" + PREFIX)
    descriptor = lock(path)
    # Only now has it a name under which others look for what the dead have left.
    path, unlocked_name = os.path.join(os.path.dirname(path), os.path.basename(path)[len("new-") :]), path
    os.rename(unlocked_name, path)
    try:
        for file in files:
            os.symlink(file, os.path.join(path, os.path.basename(file)))
        yield path
    finally:
        shutil.rmtree(path, ignore_errors=True)
        os.close(descriptor)


def remove_left_folders():
    parent = tempfile.gettempdir()
    for name in os.listdir(parent):
        path = os.path.join(parent, name)
        if not name.startswith(PREFIX) or os.path.islink(path) or not os.path.isdir(path):
            continue
        try:
            descriptor = lock(path)
        except OSError:
            continue  # somebody else's, or just gone
        if descriptor is not None:
            shutil.rmtree(path, ignore_errors=True)
            os.close(descriptor)
