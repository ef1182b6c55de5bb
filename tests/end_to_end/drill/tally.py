"""Counts of failures: results lost or counted twice, exports that differ, and other faults."""

import time


class Tally:
    """The row of one fault in the drill's table."""

    def __init__(self, name):
        self.name = name
        self.tried = self.lost = self.double = self.different = self.other = 0
        self.seconds = 0.0
        self.remarks = []  # measurements for the foot of the table
        self.complaints = []

    def complain(self, campaign, message, column="other", count=1):
        setattr(self, column, getattr(self, column) + count)
        self.complaints.append(f"{self.name}, try {self.tried}: {message}\n{campaign.log()[-2000:]}")

    def expect(self, campaign, truth, message):
        if not truth:
            self.complain(campaign, message)

    def judge(self, campaign, tried=1, code=None):
        """Runs the disturbed campaign to its end and compares it with the undisturbed one. `code` is the
        expected exit code, by default the undisturbed one."""
        self.tried += tried
        campaign.settle()
        campaign.acknowledge()
        ended = campaign.run()
        expected, export, files = campaign.lab.undisturbed(campaign)
        code = code or expected
        self.expect(campaign, ended == code, f"the last run ended with exit code {ended}, not {code}")
        if campaign.export() != export:
            self.complain(campaign, "the export differs from the undisturbed one", "different")
        others = [key for key, hash in campaign.hashes_of_files().items() if files.get(key, hash) != hash]
        if others:
            self.complain(campaign, f"files differ from the undisturbed ones: {others[:5]}", "different", len(others))
        self._count_losses(campaign)
        self._count_doubles(campaign)
        wrong = campaign.misplaced_files()
        patience = time.monotonic() + 10
        while any(path.startswith("spool/") for path in wrong) and time.monotonic() < patience:
            time.sleep(0.1)  # a dead worker that is not reaped yet looks alive
            campaign.run()
            wrong = campaign.misplaced_files()
        self.expect(campaign, not wrong, f"files of realisations are not where they should be: {wrong[:5]}")
        verdict = campaign.count("PRAGMA integrity_check")
        self.expect(campaign, verdict == "ok", f"integrity_check: {verdict}")
        campaign.close()

    def _count_losses(self, campaign):
        """Counts acknowledged results that are absent, changed or recomputed as lost."""
        stored = {
            (point, seed): state
            for point, seed, state in campaign.query(
                "SELECT substr(hash, 1, 16), seed, final_state_sha256 FROM realisation JOIN point USING (point_id) "
                "JOIN result USING (point_id, seed) WHERE state IN ('done', 'failed')"
            )
        }
        latest = {
            (point, seed): attempt
            for point, seed, attempt in campaign.query(
                "SELECT substr(hash, 1, 16), seed, max(attempt_id) FROM attempt JOIN point USING (point_id) GROUP BY "
                "1, 2"
            )
        }
        lost = [
            key for key, (state, last) in campaign.safe.items() if stored.get(key) != state or latest.get(key, 0) > last
        ]
        if lost:
            self.complain(campaign, f"acknowledged and lost: {sorted(lost)}", "lost", len(lost))

    def _count_doubles(self, campaign):
        ended = campaign.count("SELECT count(*) FROM realisation WHERE state IN ('done', 'failed')")
        results = campaign.count("SELECT count(*) FROM result")
        credited = campaign.count(
            "SELECT count(*) FROM (SELECT 1 FROM attempt WHERE outcome = 'result' "
            "GROUP BY point_id, seed HAVING count(*) > 1)"
        )
        again = campaign.count(
            "SELECT count(*) FROM attempt late JOIN attempt first USING (point_id, seed) "
            "WHERE first.outcome = 'result' AND late.attempt_id > first.attempt_id"
        )
        extra = abs(results - ended) + credited + again
        if extra:
            self.complain(
                campaign,
                f"{ended} ended, {results} results, {credited} credited twice, {again} run again after " "their result",
                "double",
                extra,
            )

    def count(self, counts, between=""):
        """Adds a remark on how often each of several things happened."""
        self.remarks.append(", ".join(f"{number} {between}{what}" for what, number in sorted(counts.items())))

    def row(self):
        return [self.name, self.tried, self.lost, self.double, self.different, self.other, f"{self.seconds:.0f}"]

    def passed(self):
        return self.tried > 0 and not (self.lost or self.double or self.different or self.other)
