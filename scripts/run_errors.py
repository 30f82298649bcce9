# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of the scripts, and how they show a text that may be anything."""


import sys


class InputError(Exception):
    """An error that the user can correct. The message names the file."""


def one_line(text, length=200):
    """The text on one line of printable characters, cut to the given length."""
    line = "".join(c if c.isprintable() else " " for c in str(text))
    return line if len(line) <= length else line[:length - 3] + "..."


def exit_code(work, arguments, failures=(OSError,)):
    """Does work(arguments), which can be stopped and started again, and prints its error. Returns the
    exit code: 0 done, 1 a failure or an interruption, 2 an error that the user can correct."""
    try:
        work(arguments)
        return 0
    except InputError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("error: interrupted; start again to go on", file=sys.stderr)
        return 1
    except failures as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
