#!/usr/bin/python3
"""tidy.py BUILD [PART...]      runs clang-tidy on all that BUILD compiles, or on files with PART in their path
tidy.py BUILD --programs     on all but the tests: half of the files

A unity build is checked as it is compiled, a folder at once, in a third of the time of single files. Two
checks need single files: misc-unused-using-decls and misc-unused-alias-decls (build/dev). The exit code is
1 if something was found or no file was checked.
"""
import concurrent.futures
import json
import os
import subprocess
import sys

# A unity source includes sources on purpose.
CHECKS = "--checks=-bugprone-suspicious-include"


def look_through(build, path):
    done = subprocess.run(
        ["clang-tidy", "--quiet", CHECKS, "-p", build, path], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    return done.returncode, done.stdout + (done.stderr if done.returncode else "")


def main():
    build, parts = sys.argv[1], sys.argv[2:]
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as commands:
        files = sorted({command["file"] for command in json.load(commands)})
    files = [path for path in files if path.endswith((".cpp", ".cxx"))]
    if parts == ["--programs"]:
        files = [path for path in files if "/tests/" not in path]
    else:
        files = [path for path in files if not parts or any(part in path for part in parts)]
    faulty = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as threads:
        for code, text in threads.map(lambda path: look_through(build, path), files):
            faulty += code != 0
            print(text, end="", flush=True)
    print(f"clang-tidy: {len(files)} files, {faulty} with findings")
    return faulty > 0 or not files


if __name__ == "__main__":
    sys.exit(main())
