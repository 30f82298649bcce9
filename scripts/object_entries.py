# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the observations of objects from their own file into the entries of the objects."""

import json

OBSERVATIONS = "objects_observations.json"


def attach_observations(path, content):
    """Replaces the number of observations of each object by the list of its observations.

    `content` is the content of the file objects.json at `path`. The observations are read from
    objects_observations.json next to it. Lists, as in files of version 1, are left as they are.
    Raises ValueError, KeyError or TypeError if the files are broken or do not belong together.
    """
    entries = [entry for entry in content["objects"]
               if isinstance(entry, dict) and isinstance(entry.get("observations"), int)]
    if not entries:
        return
    try:
        text = path.with_name(OBSERVATIONS).read_text(encoding="utf-8")
        views = json.loads(text)["observations"]
    except OSError as error:
        raise ValueError(f"cannot read {OBSERVATIONS}: {error.strerror}") from error
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{OBSERVATIONS} is not valid JSON: {error}") from error
    of_object = {}
    for view in views:
        of_object.setdefault(view["object"], []).append(view)
    for entry in entries:
        found = of_object.get(entry["id"], [])
        if len(found) != entry["observations"]:
            raise ValueError(f"{OBSERVATIONS} has {len(found)} observations of object {entry['id']}, "
                             f"expected {entry['observations']}")
        entry["observations"] = found
