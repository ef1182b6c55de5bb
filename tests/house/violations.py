#!/usr/bin/python3
"""violations.py FOLDER [NAME...]

Tests that each check of .ci/run finds its faults. Copies the source into FOLDER, commits one fault at a
time, and runs the check for it, first without the fault. Takes minutes, and is run by hand.
"""
import os
import shutil
import subprocess
import sys

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
TEST = "tests/contract/json_test.cpp"
SANITIZED = (
    "cmake --preset asan-ubsan -DBUILD_TESTING=ON && cmake --build --preset asan-ubsan --target contract_tests"
    " && build/asan-ubsan/bin/contract_tests --gtest_brief=1"
)
RELEASE = (
    "cmake --preset release && cmake --build --preset release --target contract_tests"
    " && build/release/bin/contract_tests --gtest_brief=1"
)
LAYERS = "/usr/bin/python3 tests/house/layering.py"
TIDY = (
    "cmake --preset release && cmake --build --preset release --target provenance_facts"
    " && /usr/bin/python3 tests/house/tidy.py build/release peclet_contract"
)
FORM = "cmake --preset release && ctest --preset release -R Format.OfCxx --no-tests=error"


def test(body):
    return "\n#include <cassert>\nTEST(Violation, IsSeen) {\n" + body + "\n}\n"


# Name: the check, the file with the fault, the fault, and part of the report.
VIOLATIONS = {
    "address": (SANITIZED, TEST, test("  const std::vector<int> v(3);\n  EXPECT_EQ(*(v.data() + 3), 0);"), "overflow"),
    "undefined": (
        SANITIZED,
        TEST,
        test("  volatile int i = 2147483647;\n  i = i + 1;"),
        "runtime error: signed integer",
    ),
    "assertion": (RELEASE, TEST, test("  volatile int i = 1;\n  assert(i == 2);"), "Assertion `i == 2' failed"),
    "tidy": (
        TIDY,
        "contract/sha256.cpp",
        "std::string moved(std::string a) {\n  const std::string b = std::move(a);\n  return a + b;\n}\n",
        "bugprone-use-after-move",
    ),
    "form": (FORM, "contract/sha256.cpp", "int   badly_spaced;\n", "clang-format-violations"),
    "layers": (LAYERS, "runner/campaign/quoting.cpp", '#include "runner/owner/campaign_state.h"\n', "may not include"),
    "sql": (LAYERS, "runner/campaign/quoting.cpp", 'const char* rows = "SELECT 1";\n', "SQL outside of runner/store"),
}


def run(command, folder):
    done = subprocess.run(
        ["bash", "-c", command], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False
    )
    return done.returncode, done.stdout


def main():
    folder, names = sys.argv[1], sys.argv[2:] or list(VIOLATIONS)
    files = subprocess.check_output(["git", "ls-files"], cwd=SOURCE, text=True).splitlines()
    for file in files:
        os.makedirs(os.path.dirname(os.path.join(folder, file)), exist_ok=True)
        shutil.copy(os.path.join(SOURCE, file), os.path.join(folder, file))
    run("git init -q && git add .", folder)
    unseen, sound = 0, set()
    for name in names:
        check, file, fault, said = VIOLATIONS[name]
        if check not in sound:
            code, output = run(check, folder)
            if code != 0:
                sys.exit(f"{name}: the check fails without the fault:\n{output}")
            sound.add(check)
        path = os.path.join(folder, file)
        with open(path, "a", encoding="utf-8") as source:
            source.write(fault)
        code, output = run(check, folder)
        shutil.copy(os.path.join(SOURCE, file), path)
        seen = code != 0 and said in output
        line = next((line for line in output.splitlines() if said in line), output)
        print(f"{name}: {'seen' if seen else 'NOT SEEN'}, exit code {code}: {line.strip()}", flush=True)
        unseen += not seen
    return unseen > 0


if __name__ == "__main__":
    sys.exit(main())
