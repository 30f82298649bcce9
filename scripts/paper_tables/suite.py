# SPDX-License-Identifier: GPL-3.0-or-later
"""The synthetic suite: which sequences make_synthetic can render for the tables."""

import pathlib
import subprocess
import tempfile

from paper_tables.sequences import Sequence
from run_errors import InputError, one_line
from run_statistics import try_read_json

FRAMES = 300  # of a sequence of the suite, unless --frames says otherwise
LISTING_FRAMES = "2"  # enough to learn which sequences there are


def suite_file(program, cache):
    """The content of suite.json: that of the file `cache`, else from a rendering of very few
    frames."""
    known = try_read_json(cache)
    if known is not None:
        return known
    with tempfile.TemporaryDirectory() as folder:
        target = pathlib.Path(folder) / "suite"
        command = [str(program), "--suite", str(target), "--frames", LISTING_FRAMES, "--quiet"]
        result = subprocess.run(command, capture_output=True, text=True, check=False)
        if result.returncode != 0:
            raise InputError(f"{program}: cannot render the suite: "
                             f"{one_line(result.stderr.strip() or 'no message')}")
        content = try_read_json(target / "suite.json")
        if content is None:
            raise InputError(f"{program}: has written no valid suite.json")
    return content


def read_suite(content, paper_sequences, frames):
    """The sequences that a suite.json lists. Each is rendered by itself, for each seed."""
    try:
        return [rendered_sequence(entry, paper_sequences, frames) for entry in content["sequences"]]
    except (KeyError, TypeError, AttributeError) as error:
        reason = f"no key {error}" if isinstance(error, KeyError) else one_line(error)
        raise InputError(f"suite.json of make_synthetic: not as expected: {reason}") from error


def rendered_sequence(entry, paper_sequences, frames):
    name, paper = entry["name"], entry["plays"]
    length = "" if frames is None else f"-frames-{frames}"
    suite = f"sequences/{name}/seed-{{seed}}{length}"
    return Sequence(name, entry["dataset"], paper if paper in paper_sequences else None,
                    folder=f"{suite}/{entry['folder']}", masks=f"{suite}/{entry['masks']}",
                    objects=f"{suite}/{entry['objects']}", note=entry["special"],
                    frames=frames or FRAMES, has_rolling_shutter=entry["readout_time"] != 0.0,
                    rendered={"suite": suite, "options": [
                        "--only", name, *(["--frames", str(frames)] if frames else [])]})
