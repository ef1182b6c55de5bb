#!/usr/bin/python3
"""The terminal used for pictures shows what a real terminal shows."""
import unittest

from terminal import Screen, watched


class Terminal(unittest.TestCase):
    def shown(self, text, rows=4, columns=10):
        screen = Screen(rows, columns)
        for character in text:  # sequences arrive in pieces
            screen.feed(character)
        return screen.text()

    def test_lines_are_folded_and_scrolled(self):
        self.assertEqual(self.shown("abc\r\ndef"), "abc\ndef")
        self.assertEqual(self.shown("0123456789ab"), "0123456789\nab")
        self.assertEqual(self.shown("1\r\n2\r\n3\r\n4\r\n5"), "2\n3\n4\n5")

    def test_what_is_drawn_again_replaces_what_was_there(self):
        self.assertEqual(self.shown("long line\r\nx\r\ny\x1b[Hshort\x1b[K\r\nz\x1b[J"), "short\nz")
        self.assertEqual(self.shown("abc\x1b[2;3Hd\x1b[2Je"), "\n   e")

    def test_styles_are_those_of_html(self):
        screen = Screen(1, 9)
        screen.feed("\x1b[1mb\x1b[0m\x1b[31m<\x1b[0mn\x1b[?25l")
        text = screen.html()
        self.assertIn('<span style="font-weight: bold">b</span><span style="color: #c4341c">&lt;</span>n', text)

    def test_a_program_knows_the_size_and_is_ended(self):
        screen = watched(["/bin/sh", "-c", "stty size; sleep 60"], 5, 33, 2)
        self.assertIn("5 33", screen.text())
        self.assertEqual(watched(["/bin/echo", "done"], 5, 33, 60).text(), "done")

    def test_what_is_not_known_is_said(self):
        with self.assertRaises(ValueError):
            self.shown("\x1b[5S")


if __name__ == "__main__":
    unittest.main()
