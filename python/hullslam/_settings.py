# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings by the names that they have in settings files (docs/settings.md).

Everything here comes from the registry of settings of the library, so a new setting needs no edit.
"""

import numbers
import os
import warnings

from . import _core


def _to_text(key, value):
    """The text that a settings file would have for this value."""
    if isinstance(value, str):
        return value
    if isinstance(value, bool) or type(value).__name__ == "bool_":
        return "true" if value else "false"
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        return repr(float(value))
    if isinstance(value, dict):
        return ",".join(f"{name}:{_to_text(key, number)}" for name, number in value.items())
    raise _core.InputError(f"Settings: {key} is a {type(value).__name__}, "
                           "expected a number, a bool, a str or a dict")


def _to_value(text, expected):
    """The value of a setting as Python's type. `expected` is the registry's description of it."""
    if expected.startswith("an integer"):
        return int(text)
    if expected.startswith("a number"):
        return float(text)
    if expected.startswith("true or false"):
        return text == "true"
    if expected.startswith("name:number"):
        pairs = (pair.rsplit(":", 1) for pair in text.split(",") if pair)
        return {name: float(number) for name, number in pairs}
    return text


def _flatten(values, prefix=""):
    """Pairs of a key and a value from dicts in dicts: {"objects": {"min_views": 4}}.

    A dict is a group of settings, except where the setting itself is a dict of numbers by name.
    """
    for name, value in values.items():
        key = prefix + name
        if isinstance(value, dict) and key not in _MAPS:
            yield from _flatten(value, key + ".")
        else:
            yield key, value


def overrides_of(values):
    """The keyword arguments of Settings as key=value."""
    return [f"{key}={_to_text(key, value)}" for key, value in _flatten(values)]


class Group:
    """The settings whose keys begin with the same words, such as `settings.objects.start`."""

    __slots__ = ("_table", "_prefix")

    def __init__(self, table, prefix):
        object.__setattr__(self, "_table", table)
        object.__setattr__(self, "_prefix", prefix)

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        return self._table._find(self._prefix + name, AttributeError)

    def __setattr__(self, name, value):
        self._table[self._prefix + name] = value

    def __dir__(self):
        return self._table._names(self._prefix)

    def __repr__(self):
        lines = [line for line in self._table.summary().splitlines()
                 if line.startswith(self._prefix)]
        return "\n".join(lines)


class Settings(_core.SettingsTable):
    """All settings of a run.

        settings = Settings("TUM1.yaml", objects={"start": {"min_views": 4}}, ORBextractor={"nFeatures": 1500})
        settings.objects.detection.min_score = 0.5
        settings["tracking.min_inliers"]

    file: a settings file of HullSLAM, ORB-SLAM2 or ORB-SLAM3. Without it, Camera must have the
        intrinsics: Camera={"fx": 517.3, "fy": 516.5, "cx": 318.6, "cy": 255.3}.
    preset: the name or file of a preset (preset_names()).
    Keyword arguments: groups of settings as dicts, or single settings, which replace those of the
        preset and of the file. dict keys may have several words: {"objects.start.min_views": 4}.

    Raises InputError that names the file, line, key and value, and what was expected.
    """

    def __init__(self, file=None, *, preset=None, **values):
        if isinstance(file, _core.SettingsTable):  # of open()
            super().__init__(file)
        else:
            preset = None if preset is None else os.fspath(preset)
            super().__init__(file, preset, overrides_of(values))
        for warning in self.warnings:
            warnings.warn(warning, stacklevel=2)

    def _find(self, key, error):
        """The value of `key`, or the group of this name."""
        is_group = False
        for entry, text, _, expected, _, _ in self.entries():
            if entry == key:
                return _to_value(text, expected)
            is_group = is_group or entry.startswith(key + ".")
        if is_group:
            return Group(self, key + ".")
        raise error(self._unknown(key))

    def _unknown(self, key):
        """What the registry says about a key that it does not have, with the nearest one."""
        try:
            self.set_text(key, "")
        except _core.InputError as error:
            return str(error)
        raise AssertionError(f"{key} is a setting")

    def _names(self, prefix):
        """The next words of all keys that begin with `prefix`."""
        keys = (entry[0] for entry in self.entries())
        return sorted({key[len(prefix):].split(".")[0] for key in keys if key.startswith(prefix)})

    def __getitem__(self, key):
        return self._find(key, KeyError)

    def __setitem__(self, key, value):
        if isinstance(value, dict) and key not in _MAPS:
            for name, inner in _flatten(value, key + "."):
                self[name] = inner
        else:
            self.set_text(key, _to_text(key, value))

    def __getattr__(self, name):
        if name.startswith("_"):
            raise AttributeError(name)
        return self._find(name, AttributeError)

    def __setattr__(self, name, value):
        self[name] = value

    def __dir__(self):
        return [*super().__dir__(), *self._names("")]

    def describe(self, key):
        """The meaning of a setting, and the values that it may have."""
        for entry, _, default, expected, meaning, _ in self.entries():
            if entry == key:
                return f"{key}: {meaning} ({expected}; default {default})"
        raise KeyError(self._unknown(key))

    def summary(self, *, changed_only=False):
        """All settings as text, one line each. Those that differ from the default say so."""
        lines = []
        for key, text, default, _, _, is_shared in self.entries():
            is_changed = text != default
            if not is_shared and (is_changed or not changed_only):
                lines.append(f"{key}: {text}" + (f"  (default {default})" if is_changed else ""))
        return "\n".join(lines)

    def write(self, path):
        """Writes all settings to a file that Settings() reads."""
        text = self.format()
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def __repr__(self):
        changed = self.summary(changed_only=True).count("\n") + 1
        width, height = self.image_size
        return f"<hullslam.Settings: {width}x{height} px, {changed} settings are not the default>"


# The settings that are numbers by name.
_MAPS = {entry[0] for entry in _core.SettingsTable.defaults()
         if entry[3].startswith("name:number")}
