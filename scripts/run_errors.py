# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of the scripts, and how they show a text that may be anything."""


class InputError(Exception):
    """An error that the user can correct. The message names the file."""


def one_line(text, length=200):
    """The text on one line of printable characters, cut to the given length."""
    line = "".join(c if c.isprintable() else " " for c in str(text))
    return line if len(line) <= length else line[:length - 3] + "..."
