#!/usr/bin/python3
"""screenshots.py BIN FOLDER: runs a small campaign and writes pictures of its page.

wide.png, telephone.png (360 pixels), dark.png, unfolded.png (everything that is folded, and the stress by term),
provisional.png (half way), top.png (its upper part), and paper.pdf as it is printed. Half a minute on two cores.
"""

import os
import sys
import tempfile

from browser import Browser
from campaign_page import SCENE, Folder, campaign, choose, open_folds

FLOW_CURVE = dict(
    SCENE,
    particles={
        "count": 100,
        "density": 0.1,
        "species": [{"radius": 1.0, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}],
    },
    duration={"equilibration": {"strain": 0.75}, "production": {"strain": 0.5}},
)
SWEEP = {"/volume_fraction": [0.3, 0.4, 0.45, 0.5], "/peclet": [1, 10, 100, 1000]}


def main(binaries, target):
    os.makedirs(target, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="peclet-page-") as place, Browser() as browser:
        folder = Folder(binaries, place)

        def picture(name, page, whole=True):
            if page.complaints:
                raise SystemExit(f"{name}: {page.complaints}")
            page.picture(os.path.join(target, name), whole)

        file = folder.write(campaign("flow-curve", SWEEP, tolerance=0.05, maximum=60, scene=FLOW_CURVE))
        folder.peclet("plan", file, "--pilot", "4")
        picture("provisional.png", browser.open(folder.report(file)))
        folder.peclet("run", file, "--quiet", allowed=(0, 3))
        path = folder.report(file)
        picture("wide.png", browser.open(path))
        top = browser.open(path, width=1000, height=880)
        top.evaluate("document.querySelector('#sweep svg').scrollIntoView({block: 'center'}); scrollTo(0, 0)")
        picture("top.png", top, whole=False)
        picture("telephone.png", browser.open(path, width=360, touch=True))
        dark = browser.open(path, dark=True)
        choose(dark, "#quantity", "first normal difference")
        picture("dark.png", dark)
        unfolded = browser.open(path)
        choose(unfolded, "#quantity", "stress by term, xy")
        open_folds(unfolded)
        picture("unfolded.png", unfolded)
        browser.open(path).print(os.path.join(target, "paper.pdf"))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    main(os.path.abspath(sys.argv[1]), sys.argv[2])
