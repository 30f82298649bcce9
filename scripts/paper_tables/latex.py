# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables as a LaTeX document that compiles by itself, with booktabs."""

from paper_tables.text import DASH, claims_grid, grids, preface, ranking_grid

SPECIAL = {"\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_",
           "{": r"\{", "}": r"\}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
           DASH: "--", "<": r"\textless{}", ">": r"\textgreater{}", "|": r"\textbar{}"}
HEAD = r"""% Made by scripts/reproduce_tables.py. A single table can be copied into a paper; it needs the
% packages booktabs and longtable.
\documentclass[10pt]{article}
\usepackage[utf8]{inputenc}
\usepackage[a3paper,landscape,margin=15mm]{geometry}
\usepackage{booktabs}
\usepackage{longtable}
\setlength{\LTleft}{0pt}
\setlength{\tabcolsep}{3pt}
\begin{document}
\scriptsize
"""


def escape(text):
    """A text in which LaTeX sees no command. What is no ASCII becomes a question mark, because the
    fonts may lack it."""
    return "".join(SPECIAL.get(c, c if c.isascii() and c.isprintable() else "?") for c in text)


def cell_text(item):
    text = escape(item.text)
    return rf"\textbf{{{text}}}" if item.is_best else text


def column_kinds(grid):
    """Columns as wide as their texts; long texts are broken into lines."""
    kinds = []
    for index in range(len(grid.head)):
        longest = max(len(row[index].text) for row in grid.rows if len(row) > index)
        kinds.append(r"p{80mm}" if longest > 70 else "l" if index == 0 else "r")
    return "".join(kinds)


def heading(text, kind):
    """The heading of a column, in short lines."""
    lines, line = [], ""
    for word in text.split():
        if line and len(line) + len(word) > 14:
            lines.append(line)
            line = word
        else:
            line = f"{line} {word}".strip()
    lines.append(line)
    if kind == "p" or len(lines) == 1:
        return escape(text)
    broken = r" \\ ".join(map(escape, lines))
    return rf"\begin{{tabular}}[b]{{@{{}}r@{{}}}}{broken}\end{{tabular}}"


def grid_lines(grid):
    width = len(grid.head)
    kinds = column_kinds(grid)
    heads = [heading(text, kind) for text, kind in zip(grid.head, kinds.replace("{80mm}", ""))]
    lines = [rf"\begin{{longtable}}{{{kinds}}}", rf"\caption{{{escape(grid.title)}}}\\",
             r"\toprule", " & ".join(heads) + r" \\", r"\midrule", r"\endhead", r"\bottomrule",
             r"\endfoot"]
    for index, row in enumerate(grid.rows):
        if len(row) == 1:
            lines += [r"\addlinespace"] if index else []
            lines.append(rf"\multicolumn{{{width}}}{{l}}{{\textit{{{escape(row[0].text)}}}}} \\")
        else:
            lines.append(" & ".join(cell_text(item) for item in row) + r" \\")
    lines.append(r"\end{longtable}")
    for note in grid.notes:
        lines += [rf"\noindent {escape(note)}\par"]
    return [*lines, ""]


def latex(report):
    lines = [HEAD.rstrip("\n")]
    for line in preface(report):
        lines.append(rf"\noindent {escape(line)}\par")
    for block in report.blocks:
        for grid in (*grids(report, block), ranking_grid(report, block)):
            if grid is not None and grid.rows:
                lines += ["", *grid_lines(grid)]
    if report.claims:
        lines += ["", *grid_lines(claims_grid(report))]
    return "\n".join([*lines, r"\end{document}"]) + "\n"
