# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the main function of a script in the process of the test, which is faster than a new process."""

import contextlib
import io
import types


def run_main(main, *arguments):
    """The exit code (returncode) and what was printed (stdout, stderr)."""
    out, errors = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors):
        try:
            code = main([str(word) for word in arguments])
        except SystemExit as end:  # bad usage
            code = end.code
    return types.SimpleNamespace(returncode=code, stdout=out.getvalue(), stderr=errors.getvalue())
