#!/usr/bin/python3
"""live_page_test.py BIN: the page of `peclet serve` in a browser, before, during and after a campaign."""

import json
import os
import shutil
import signal
import sqlite3

from campaign_page import Folder, campaign, choose, rows, saved, switch
from page_case import PageTest, Stage, main

HOSTILE = "</script><img src=x onerror=\"window.hacked=1\">'''\\\"\n=1+1"
SWEEP = {"/volume_fraction": [0.1, 0.2], "/peclet": [1, 10, 100]}
HEADLINE = "document.getElementById('headline').textContent"
LIVE = "document.getElementById('live').textContent"


class LiveTest(PageTest):
    """Each test has a campaign of its own, which `self.folder` runs."""

    def setUp(self):
        path = Stage.folder.file(self.id().rsplit(".", 1)[1])
        os.mkdir(path)
        self.folder = Folder(Stage.binaries, path)

    def write(self):
        return self.folder.write(campaign("live", SWEEP))

    def copy(self):
        """Returns the folder of a completed campaign, and its database."""
        shutil.copytree(Stage.folder.file("curve.peclet"), self.folder.file("copy.peclet"))
        return "copy.peclet", sqlite3.connect(self.folder.file("copy.peclet/campaign.db"))

    def serve(self, file):
        server = self.folder.serve(file)
        self.addCleanup(lambda: server.process.poll() is not None or server.end())
        return server

    def look(self, server, **how):
        page = Stage.browser.open(server.address, **how)
        self.addCleanup(lambda: self.assertEqual(page.complaints, []))
        return page


class Life(LiveTest):
    def test_it_waits_and_follows_a_campaign_to_its_end(self):
        file = self.write()
        server = self.serve(file)
        page = self.look(server)
        self.assertIn(f"Waiting for `peclet run {file}`", page.evaluate(HEADLINE))
        self.assertTrue(page.evaluate("document.querySelector('main').hidden"))
        self.folder.peclet("plan", file, "--pilot", "4")
        page.wait_for(f"{HEADLINE}.startsWith('0 of 6 points decided')")
        # The first state may be from the pilot run.
        page.wait_for("document.querySelectorAll('#sweep svg g.provisional .target').length === 6")
        self.folder.peclet("run", file, "--quiet", allowed=(0, 3))
        page.wait_for(f"{HEADLINE}.startsWith('6 of 6 points decided')")
        exported = {row["label"]: row for row in rows(self.folder.peclet("export", file, "--csv"))}
        for place in ("#results", "#sweep"):
            table = rows(saved(page, place, "CSV"))
            self.assertEqual([row["label"] for row in table], list(exported))
            for row in table:
                for key in ("mean", "standard_error", "half_width"):
                    self.assertEqual(float(row[key]), float(exported[row["label"]][key]), (place, key))
        self.assertEqual(server.end(signal.SIGINT), int(self.checked(file)))

    def checked(self, file):
        """Returns the exit code of `status --check`."""
        for code in (0, 3, 4, 6):
            try:
                self.folder.peclet("status", file, "--check", allowed=(code,))
                return code
            except AssertionError:
                continue
        raise AssertionError("status --check has another exit code")

    def test_what_was_chosen_stays(self):
        file = self.write()
        self.folder.peclet("plan", file, "--pilot", "4")
        page = self.look(self.serve(file), height=500)
        choose(page, "#quantity", "pressure")
        choose(page, "#axis", "Péclet number")
        choose(page, "#panels", "volume fraction")
        switch(page, "#log-x", False)
        page.evaluate("document.querySelectorAll('#results th button')[3].click()")
        choose(page, "#point select", "volume_fraction=0.2 peclet=10")
        page.evaluate("for (const details of document.querySelectorAll('details')) details.open = true")
        page.evaluate("document.querySelector('#results tbody tr:nth-child(2) button').focus()")
        focused = page.evaluate("document.activeElement.textContent")
        page.evaluate("scrollTo(0, 700)")
        state = """JSON.stringify([...['quantity', 'axis', 'panels'].map(id =>
            document.getElementById(id).selectedOptions[0].text), document.getElementById('log-x').checked,
            document.querySelectorAll('#results th')[3].getAttribute('aria-sort'),
            document.querySelector('#point select').selectedOptions[0].text,
            document.querySelectorAll('details:not([open])').length,
            Math.round(document.activeElement.getBoundingClientRect().top)])"""
        before = page.evaluate(state)
        self.assertEqual(json.loads(before)[3:5], [False, "ascending"])
        self.folder.peclet("run", file, "--quiet", allowed=(0, 3))
        page.wait_for(f"{HEADLINE}.startsWith('6 of 6 points decided')")
        self.assertEqual(page.evaluate(state), before)
        self.assertEqual(page.evaluate("document.activeElement.textContent"), focused)
        means = page.evaluate("[...document.querySelectorAll('#results tbody tr')].map(r => r.cells[3].textContent)")
        values = [float(text.split(" ")[0]) for text in means]
        self.assertEqual(values, sorted(values))

    def test_it_says_when_the_server_is_gone(self):
        server = self.serve(Stage.folder.file("curve.json"))
        page = Stage.browser.open(server.address)
        page.wait_for(f"{LIVE}.startsWith('Live; last change ')")
        server.process.kill()
        server.process.communicate()
        page.wait_for(f"{LIVE}.startsWith('The server has not answered since ')")
        self.assertEqual(page.evaluate("document.getElementById('live').className"), "alarm")
        # The browser's own message about the refused connection is the only complaint.
        self.assertEqual([one for one in page.complaints if "ERR_CONNECTION_REFUSED" not in one], [])

    def test_a_damaged_database_is_told_beside_what_was_known(self):
        name, database = self.copy()
        page = self.look(self.serve(name))
        with database:
            database.execute("UPDATE stop_test SET count = count + 1")
            database.execute("UPDATE realisation SET cpu_seconds = cpu_seconds + 1")
        page.wait_for(f"{LIVE}.startsWith('The campaign cannot be read: ')")
        self.assertEqual(page.evaluate("document.querySelectorAll('#results tbody tr').length"), 9)
        with database:
            database.execute("UPDATE stop_test SET count = count - 1")
        database.close()
        page.wait_for(f"{LIVE}.startsWith('Live; ')")


class Looks(LiveTest):
    def test_details_come_when_a_point_is_chosen(self):
        page = self.look(self.serve(Stage.folder.file("curve.json")))
        for label in ("volume_fraction=0.1 peclet=1", "volume_fraction=0.3 peclet=100"):
            choose(page, "#point select", label)
            page.wait_for("document.querySelectorAll('#point .pair')[1].querySelectorAll('figure').length > 0")
            name = page.evaluate("document.querySelectorAll('#point .pair')[1].querySelector('a').download")
            self.assertIn(label.replace("=", "-").replace(" ", "-"), name)

    def test_it_is_the_page_of_the_report(self):
        live, report = self.look(self.serve(Stage.folder.file("curve.json"))), self.open()
        text = "[...document.querySelectorAll('#sweep text, #results td, #cost td')].map(one => one.textContent).join()"
        self.assertEqual(live.evaluate(text), report.evaluate(text))

    def test_nothing_is_wider_than_a_telephone(self):
        for dark in (False, True):
            page = self.look(self.serve(Stage.folder.file("young.json")), width=360, dark=dark, touch=True)
            page.wait_for("document.querySelectorAll('#point .pair')[1].querySelectorAll('figure').length > 0")
            page.evaluate("for (const details of document.querySelectorAll('details')) details.open = true")
            self.assertEqual(page.evaluate("document.documentElement.scrollWidth"), 360)

    def test_a_hostile_name_is_text(self):
        name, database = self.copy()
        with database:
            database.execute("UPDATE campaign SET name = ?", (HOSTILE,))
            database.execute("UPDATE point SET label = ? || place", (HOSTILE,))
            database.execute("UPDATE attempt SET host = ?, outcome = 'crashed'", (HOSTILE,))
            database.execute("UPDATE lease SET phase = ?", (HOSTILE,))
        page = self.look(self.serve(name))
        with database:
            database.execute("UPDATE point SET label = ? || place || '+'", (HOSTILE,))
        database.close()
        page.wait_for("document.querySelector('#point select').selectedOptions[0].text.endsWith('+')")
        self.assertIsNone(page.evaluate("window.hacked || null"))
        self.assertEqual(page.evaluate("document.images.length + document.scripts.length"), 2)
        self.assertEqual(page.evaluate("document.querySelector('h1').textContent"), HOSTILE)


if __name__ == "__main__":
    main()
