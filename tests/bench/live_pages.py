#!/usr/bin/python3
"""live_pages.py BIN [--pages 10] [--seconds 5] [--rounds 5] [--browser]

Measures whether open live pages slow the owner of a campaign. The owner takes in results of jobs that take
no time (BIN/fake_engine), in turn without pages and with pages that ask once a second (--browser: real
pages), in one run. Prints the owner's processor time per result, its results per second and the server's
share: the median and extremes of the rounds, and of the ratios within a round.
"""
import argparse
import contextlib
import json
import os
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "pages"))
from browser import Browser  # noqa: E402
from campaign_page import Folder  # noqa: E402
from owner_time import document, processor_time  # noqa: E402
from campaign_folder import ENDED, query  # noqa: E402


class Asking(threading.Thread):
    """Sends the requests of a page: changes every second, and details of a point every five seconds."""

    def __init__(self, server, stop):
        super().__init__(daemon=True)
        self.server, self.stop, self.failure = server, stop, None
        self.start()

    def run(self):
        try:
            token, count, hashes = "", 0, []
            while not self.stop.wait(1):
                status, _, text = self.server.ask("state?since=" + token)
                if status == 200:
                    state = json.loads(text)
                    token = state["live"]["token"]
                    hashes = hashes or [point["hash"] for point in state["points"].values()]
                count += 1
                if count % 5 == 0:
                    self.server.ask("point?hash=" + hashes[0])
        except Exception as error:  # reported by the thread that joins this one
            self.failure = error


@contextlib.contextmanager
def pages(server, number, browser):
    if browser:
        for _ in range(number):
            browser.open(server.address)
        yield
        for session in list(browser.pages):
            target = browser.pages.pop(session)
            target.call("Page.close")
        return
    stop = threading.Event()
    asking = [Asking(server, stop) for _ in range(number)]
    yield
    stop.set()
    for one in asking:
        one.join()
        if one.failure:
            raise one.failure


def window(run, folder, seconds):
    """Returns the owner's processor seconds a result, and results a second."""

    def ended():
        return query(os.path.join(folder, "campaign.peclet", "campaign.db"), ENDED)[0][0]

    before, count, begun = processor_time(run.pid), ended(), time.monotonic()
    time.sleep(seconds)
    took, taken = processor_time(run.pid) - before, ended() - count
    return took / max(1, taken), taken / (time.monotonic() - begun)


def said(what, values, unit):
    print(f"{what}: {statistics.median(values):.3g} ({min(values):.3g} .. {max(values):.3g}) {unit}", flush=True)


def measure(options, place, browser):
    folder = Folder(options.binaries, place)
    folder.environment.update({f"PECLET_FAKE_{name}": value for name, value in (("STEPS", "1"), ("DEVIATION", "5"))})
    file = folder.write(document(options.binaries, 10, 1_000_000))
    command = ["peclet", "run", file, "--workers", "2", "--quiet"]
    with subprocess.Popen(command, cwd=place, env=folder.environment, stdout=subprocess.DEVNULL) as run:
        time.sleep(3)  # until workers are busy
        alone, open_pages, server_share = [], [], []
        with folder.serve(file) as server:
            for _ in range(options.rounds):
                alone.append(window(run, place, options.seconds))
                with pages(server, options.pages, browser):
                    time.sleep(1)
                    before, begun = server.seconds(), time.monotonic()
                    open_pages.append(window(run, place, options.seconds))
                    server_share.append((server.seconds() - before) / (time.monotonic() - begun))
        run.send_signal(signal.SIGTERM)
    said("a result, no page", [1000 * cost for cost, _ in alone], "ms of the owner's processor time")
    said(f"a result, {options.pages} pages", [1000 * cost for cost, _ in open_pages], "ms")
    ratios = [with_pages[0] / without[0] for without, with_pages in zip(alone, open_pages)]
    said("ratio of the two in a round", ratios, "")
    said("results a second, ratio", [b[1] / a[1] for a, b in zip(alone, open_pages)], "")
    said("the server takes", [100 * share for share in server_share], "% of a core")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binaries", metavar="BIN")
    parser.add_argument("--pages", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=5)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--browser", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="peclet-live-") as place, contextlib.ExitStack() as leaving:
        measure(options, place, leaving.enter_context(Browser()) if options.browser else None)


if __name__ == "__main__":
    main()
