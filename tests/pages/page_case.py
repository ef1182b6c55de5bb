"""Shared parts of the page tests: a campaign run once for each test file, a young one, and a browser."""

import contextlib
import os
import sys
import tempfile
import unittest

from browser import Browser
from campaign_page import Folder, campaign, rows


class Stage:
    """Set while the tests run."""

    folder = browser = binaries = None
    leaving = contextlib.ExitStack()


def set_up(binaries):
    place = Stage.leaving.enter_context(tempfile.TemporaryDirectory(prefix="peclet-page-"))
    Stage.binaries = binaries
    folder = Stage.folder = Folder(binaries, place)
    sweep = {"/volume_fraction": [0.1, 0.2, 0.3], "/peclet": [1, 10, 100]}
    folder.peclet("run", folder.write(campaign("curve", sweep)), "--quiet", allowed=(0, 3))
    folder.report("curve.json")
    folder.peclet("plan", folder.write(campaign("young", sweep)), "--pilot", "4")
    folder.report("young.json")
    Stage.browser = Stage.leaving.enter_context(Browser())


class PageTest(unittest.TestCase):
    """No action on a page may cause a complaint of the browser."""

    def open(self, name="curve.json.html", **how):
        page = Stage.browser.open(Stage.folder.file(name), **how)
        self.addCleanup(lambda: self.assertEqual(page.complaints, []))
        return page

    def exported(self):
        """Returns the rows of `peclet export --csv` by label."""
        return {row["label"]: row for row in rows(Stage.folder.peclet("export", "curve.json", "--csv"))}


def main():
    """Runs the tests of the calling program, whose first argument is the folder of the programs."""
    binaries = os.path.abspath(sys.argv.pop(1))
    try:
        set_up(binaries)
        unittest.main(module="__main__", verbosity=1)
    finally:
        Stage.leaving.close()
