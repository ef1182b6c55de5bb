"""Makes folders for LAMMPS to run in, locked by their processes, so that those of dead processes can be removed."""
import contextlib
import fcntl
import os
import shutil
import tempfile

PREFIX = "peclet-lammps-"


def lock(path):
    """Returns a descriptor that holds the lock of a folder until it is closed, or None if another process has the lock.

    The death of the process closes it, too.
    """
    descriptor = os.open(path, os.O_RDONLY | os.O_DIRECTORY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(descriptor)
        return None
    return descriptor


@contextlib.contextmanager
def folder_with(files):
    """Yields the path of a new folder with links to `files`, and removes the folder at the end."""
    path = tempfile.mkdtemp(prefix="new-" + PREFIX)
    descriptor = lock(path)
    # Only a locked folder gets the name that remove_left_folders() looks for.
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
            continue  # of another user, or removed just now
        if descriptor is not None:
            shutil.rmtree(path, ignore_errors=True)
            os.close(descriptor)
