"""Builds the wheel and the source distribution of peclet, for pip and by `./bootstrap.sh package`.

The wheel holds what the archive of `cpack` holds, at the same places below the environment: programs in bin, pages,
adapters and studies in share. The programs are static, so one wheel suits every Linux on x86-64 and every Python 3. The
functions are those of PEP 517.
"""
import base64
import gzip
import hashlib
import io
import os
import subprocess
import tarfile
import tomllib
import zipfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parent.parent
TAG = "py3-none-manylinux_2_17_x86_64.manylinux2014_x86_64.musllinux_1_1_x86_64"
EARLIEST = (1980, 1, 1, 0, 0, 0)  # the time of every file: equal contents give equal wheels
PACKAGE = "lib/python3/dist-packages/"  # of the Python package in the archive


def project():
    """Returns the table [project] of the Python package."""
    with open(SOURCE / "python/pyproject.toml", "rb") as file:
        return tomllib.load(file)["project"]


def metadata():
    about = project()
    lines = ["Metadata-Version: 2.1", f"Name: {about['name']}", f"Version: {about['version']}"]
    lines += [f"Summary: {about['description']}", f"License: {about['license']['text']}"]
    lines += [f"Requires-Python: {about['requires-python']}"]
    lines += [f"Requires-Dist: {name}" for name in about["dependencies"]]
    for extra, names in about["optional-dependencies"].items():
        lines += [f"Provides-Extra: {extra}", *(f'Requires-Dist: {name}; extra == "{extra}"' for name in names)]
    readme = (SOURCE / "README.md").read_text("utf-8")
    return "\n".join([*lines, "Description-Content-Type: text/markdown", "", readme]).encode()


def place_in_wheel(path, data, information):
    """Returns where a file of the archive belongs in the wheel."""
    if path.startswith("bin/"):
        return f"{data}/scripts/{path.removeprefix('bin/')}"
    if path.startswith(PACKAGE):
        return path.removeprefix(PACKAGE)
    if path.startswith("share/doc/peclet/licences/"):
        return f"{information}/licences/{Path(path).name}"
    return f"{data}/data/{path}"


def files_of_archive(archive):
    """Yields path, content and permissions of each file of the archive."""
    with tarfile.open(archive) as tar:
        for member in sorted(tar.getmembers(), key=lambda member: member.name):
            if member.isfile():
                yield member.name.split("/", 1)[1], tar.extractfile(member).read(), member.mode & 0o777


def make_wheel(archive, folder):
    """Writes the wheel of an archive to a folder, and returns its name."""
    about = project()
    stem = f"{about['name']}-{about['version']}"
    information, data = f"{stem}.dist-info", f"{stem}.data"
    entries = {place_in_wheel(path, data, information): (text, mode) for path, text, mode in files_of_archive(archive)}
    tags = (f"Tag: py3-none-{platform}" for platform in TAG.split("-")[-1].split("."))
    wheel = "\n".join(["Wheel-Version: 1.0", "Generator: peclet", "Root-Is-Purelib: false", *tags, ""])
    entries[f"{information}/METADATA"] = metadata(), 0o644
    entries[f"{information}/WHEEL"] = wheel.encode(), 0o644
    entries[f"{information}/LICENSE"] = (SOURCE / "LICENSE").read_bytes(), 0o644
    record = ""
    for path, (text, _) in entries.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(text).digest()).rstrip(b"=").decode()
        record += f"{path},sha256={digest},{len(text)}\n"
    entries[f"{information}/RECORD"] = (record + f"{information}/RECORD,,\n").encode(), 0o644
    name = f"{stem}-{TAG}.whl"
    with zipfile.ZipFile(Path(folder) / name, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as file:
        for path, (text, mode) in entries.items():
            about_file = zipfile.ZipInfo(path, EARLIEST)
            about_file.external_attr = (0o100000 | mode) << 16
            about_file.compress_type = zipfile.ZIP_DEFLATED
            file.writestr(about_file, text)
    return name


def source_files():
    """Returns the paths of the source: what git keeps, or in an unpacked source distribution everything but builds."""
    if (SOURCE / ".git").exists():
        listed = subprocess.run(["git", "-C", SOURCE, "ls-files", "-z"], check=True, capture_output=True, text=True)
        return listed.stdout.split("\0")[:-1]
    found = (path.relative_to(SOURCE) for path in SOURCE.rglob("*") if path.is_file())
    return sorted(str(path) for path in found if path.parts[0] not in ("build", "PKG-INFO"))


def of_nobody(member):
    """Returns the member of an archive without owner and time: equal contents give equal archives."""
    member.uid = member.gid = member.mtime = 0
    member.uname = member.gname = ""
    return member


def build_sdist(sdist_directory, config_settings=None):
    about = project()
    stem = f"{about['name']}-{about['version']}"
    written = io.BytesIO()
    with tarfile.open(fileobj=written, mode="w", format=tarfile.PAX_FORMAT) as tar:
        for path in source_files():
            tar.add(SOURCE / path, f"{stem}/{path}", filter=of_nobody)
        text = metadata()
        member = tarfile.TarInfo(f"{stem}/PKG-INFO")
        member.size = len(text)
        tar.addfile(member, io.BytesIO(text))
    (Path(sdist_directory) / f"{stem}.tar.gz").write_bytes(gzip.compress(written.getvalue(), mtime=0))
    return f"{stem}.tar.gz"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    quiet = {"cwd": SOURCE, "check": True, "stdout": subprocess.DEVNULL}
    subprocess.run(["cmake", "--preset", "package"], **quiet)
    subprocess.run(["cmake", "--build", "--preset", "package"], cwd=SOURCE, check=True)
    subprocess.run(["cpack", "--preset", "package"], **quiet)
    archive = SOURCE / f"build/package/peclet-{project()['version']}-linux-x86_64.tar.gz"
    return make_wheel(archive, wheel_directory)


if __name__ == "__main__":
    os.chdir(SOURCE)
    print(build_wheel("build/package"))
    print(build_sdist("build/package"))
