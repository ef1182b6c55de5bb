"""The campaign's file: in the wrong place, renamed, edited in the middle."""
import os

from .folders import running
from .night import CAMPAIGN, Wrong


def other_folder(night):
    """From another folder"""
    night.has_run()
    night.types(
        "mkdir elsewhere && cd elsewhere && peclet status night.json", 2, ["night.json", "no such file or folder"]
    )
    night.types(
        "cp night.json elsewhere/ && cd elsewhere && peclet status night.json",
        2,
        ["has not been run yet", "elsewhere/night.peclet", "--directory"],
    )
    night.types("cd elsewhere && peclet status night.json --directory ../night.peclet", 0, ["2 converged"])
    night.lost_nothing()


def folder_for_file(night):
    """The folder in place of the file"""
    night.has_run()
    night.types("peclet run night.peclet/", 2, ["is a folder", "night.json"])
    night.ends()


def renamed(night):
    """The file renamed without its folder"""
    night.has_run()
    night.types(
        "mv night.json evening.json && peclet run evening.json",
        2,
        ["night.peclet has 16 results of its points", "was it renamed?"],
    )
    night.follows(r"mv [^`]*", 0, ["2 converged"])
    night.lost_nothing("evening.peclet")
    if os.path.exists(night.path("night.peclet")):
        raise Wrong("there are two folders")


def other_name(night):
    """Another name in the file"""
    night.has_run()
    night.types(
        'sed -i \'s/"night"/"evening"/\' night.json && peclet run night.json',
        0,
        ["evening: ", "2 converged"],
        ["no backup could be made"],
    )
    night.lost_nothing()


def edited(night):
    """The scene changed when half of the campaign is done"""
    run = running(night, 4, 40)
    night.types(
        'sed -i \'s/"viscosity": 1/"viscosity": 2/\' night.json && peclet status night.json',
        0,
        ["has changed since it was last run", "`peclet set night.json` or `peclet run night.json` takes it over"],
    )
    night.stops(run)
    night.waits(run, 75, ["workers checkpoint and stop"])
    night.lets_go()
    before = night.remembers()
    night.types(
        "peclet run night.json --workers 2",
        0,
        [f"{before} seeds that ended at 2 points of earlier versions", "are kept, and count again"],
    )
    night.lost_nothing()
    night.types(
        'sed -i \'s/"viscosity": 2/"viscosity": 1/\' night.json && peclet run night.json --workers 2 --quiet',
        0,
        ["2 converged"],
    )
    night.lost_nothing()


def engine_missing(night):
    """The engine is not on PATH, or may not be executed"""
    night.write(dict(CAMPAIGN, engine=["my_engine"]))
    night.types(
        "peclet run night.json", 2, ["/engine/0: my_engine", "beside peclet, on PATH, or one of peclet's adapters"]
    )
    night.write(dict(CAMPAIGN, engine=["./my_engine"]))
    night.types(
        f"cp {night.programs}/fake_engine my_engine && chmod -x my_engine && peclet run night.json",
        2,
        ["my_engine", "may not be executed", "chmod +x"],
    )
    night.follows(r"chmod [^`]*")
    night.types("peclet run night.json --quiet", 0, ["2 converged"])


def engine_rebuilt(night):
    """The engine built anew when half of the campaign is done"""
    run = running(night, 4, 40)
    night.stops(run)
    night.waits(run, 75)
    night.lets_go()
    night.remembers()
    night.environment["PECLET_FAKE_IDENTITY"] = "built at two"
    night.types("peclet run night.json --workers 2", 6, ["has results of engine", "never mixes two"])
    night.lost_nothing()
    night.follows(r"peclet run [^`]*--accept-engine [^`]*", 0, ["2 converged", "are set aside"])
    night.lost_nothing()


CASES = [other_folder, folder_for_file, renamed, other_name, edited, engine_missing, engine_rebuilt]
SLOW = [engine_rebuilt]
