# SPDX-License-Identifier: GPL-3.0-or-later
"""Says what to do if this Python lacks the packages of a script."""

import importlib.util
import sys


def require(*packages):
    """Ends the program with a message and exit code 2 if a package is missing."""
    missing = [package for package in packages if importlib.util.find_spec(package) is None]
    if missing:
        script = sys.argv[0]
        print(f"error: {sys.executable} has no {' and no '.join(missing)}. Scripts use Debian's "
              f"packages: start {script} itself or /usr/bin/python3 {script}, not another python3; "
              f"scripts/setup.sh installs {' '.join(f'python3-{package}' for package in missing)}",
              file=sys.stderr)
        sys.exit(2)
