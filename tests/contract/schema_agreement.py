#!/usr/bin/python3
"""schema_agreement.py SCHEMA FOLDER

Checks that an independent validator, given the committed schema, accepts every valid_*.json of the folder and
refuses every invalid_*.json. The C++ tests check the tables of keys with these documents. Needs Debian's
python3-jsonschema.
"""
import json
import pathlib
import sys

from jsonschema import Draft202012Validator


def disagreements(schema, folder):
    Draft202012Validator.check_schema(schema)
    validator = Draft202012Validator(schema)
    documents = sorted(folder.glob("*valid_*.json"))
    if not documents:
        yield f"{folder}: no documents"
    for path in documents:
        faults = [error.message for error in validator.iter_errors(json.loads(path.read_text()))]
        if path.name.startswith("valid_") and faults:
            yield f"{path.name}: refused: {faults[0]}"
        if path.name.startswith("invalid_") and not faults:
            yield f"{path.name}: accepted"


def main():
    schema = json.loads(pathlib.Path(sys.argv[1]).read_text())
    found = list(disagreements(schema, pathlib.Path(sys.argv[2])))
    print("\n".join(found) or "no disagreement")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
