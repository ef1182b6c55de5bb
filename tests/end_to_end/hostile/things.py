"""Objects that can be put in place of a file."""
import os
import socket
import stat

TERABYTE = 1 << 40
ROOT = os.geteuid() == 0


class NotTried(Exception):
    """This machine or user cannot make the object."""


def closed(path, trial):
    """Puts a file that its owner may neither read nor write."""
    if not os.path.lexists(path):
        rubbish(path, trial)
    os.chmod(path, 0)


def make_way(path):
    if os.path.lexists(path):
        if os.path.isdir(path) and not os.path.islink(path):
            os.rename(path, path + ".was")
        else:
            os.unlink(path)


def link(path, trial):
    """Puts a link to a file outside the campaign."""
    make_way(path)
    os.symlink(trial.victim, path)


def link_to_folder(path, trial):
    make_way(path)
    os.symlink(trial.outside, path)


def loop(path, trial):
    make_way(path)
    os.symlink(os.path.basename(path), path)


def dangling(path, trial):
    """Puts a link to an absent file, which would be made outside."""
    make_way(path)
    os.symlink(os.path.join(trial.outside, "new"), path)


def fifo(path, trial):
    make_way(path)
    os.mkfifo(path)


def folder(path, trial):
    """Puts a folder with content, which no file can replace."""
    make_way(path)
    os.makedirs(os.path.join(path, "full"))


def unix_socket(path, trial):
    make_way(path)
    place = os.open(os.path.dirname(path), os.O_DIRECTORY)
    try:  # a short path: a socket's may have 107 bytes
        with socket.socket(socket.AF_UNIX) as listener:
            listener.bind(f"/proc/self/fd/{place}/{os.path.basename(path)}")
    finally:
        os.close(place)


def device(path, trial):
    """Puts a device with /dev/full's number, whose reads give zeros without end."""
    if not ROOT:
        raise NotTried("only root makes devices")
    make_way(path)
    os.mknod(path, stat.S_IFCHR | 0o666, os.makedev(1, 7))


def sparse(path, trial):
    """Puts a sparse terabyte."""
    make_way(path)
    with open(path, "wb") as f:
        f.truncate(TERABYTE)


def rubbish(path, trial):
    make_way(path)
    with open(path, "wb") as f:
        f.write(b"\x1b[2J\x00\xff rubbish" * 1000)


def truncated(path, trial):
    os.truncate(path, os.path.getsize(path) // 2)


def empty(path, trial):
    make_way(path)
    with open(path, "wb"):
        pass


def regular(path, trial):
    """Puts a file in place of a folder."""
    make_way(path)
    with open(path, "w") as f:
        f.write("no folder")


def text(content):
    def put(path, trial):
        make_way(path)
        with open(path, "w") as f:
            f.write(content)

    return put


def foreign(path, trial):
    """Puts another user's folder, which that user can change meanwhile."""
    if not ROOT:
        raise NotTried("only root gives folders away")
    os.makedirs(path, exist_ok=True)
    os.chown(path, 12345, 12345)


def linked_folder(path, trial):
    """Puts a link to a folder elsewhere."""
    make_way(path)
    os.symlink(trial.outside, path)


def crowd(number, content="{", names="{}.json"):
    def put(path, trial):
        for i in range(trial.crowd(number)):
            with open(os.path.join(path, names.format(i)), "w") as f:
                f.write(content)

    return put


def crowd_of_links(number):
    def put(path, trial):
        for i in range(trial.crowd(number)):
            os.symlink(trial.victim, os.path.join(path, f"{i}.json"))

    return put
