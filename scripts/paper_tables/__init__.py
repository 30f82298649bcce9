# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of the paper, and one about robustness, from many runs; scripts/reproduce_tables.py
is the program."""
