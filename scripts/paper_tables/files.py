# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables as a Markdown file, and as a LaTeX document that compiles by itself, with booktabs."""

import textwrap

from paper_tables.text import DASH, Best, claims_grid, grids, preface, ranking_grid

SPECIAL = {"\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_",
           "{": r"\{", "}": r"\}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
           DASH: "--", "<": r"\textless{}", ">": r"\textgreater{}", "|": r"\textbar{}"}
LATEX_HEAD = r"""% Made by scripts/reproduce_tables.py. A single table can be copied into a paper;
% it needs the packages booktabs and longtable.
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


def all_grids(report):
    """(level of the heading, grid) of all tables, in order."""
    for block in report.blocks:
        yield from zip((2, 3), grids(report, block))
        if (order := ranking_grid(block)) is not None:
            yield 3, order
    if report.claims:
        yield 2, claims_grid(report)


# ---- Markdown


def escape_markdown(text):
    return text.replace("\\", "\\\\").replace("|", "\\|").replace("<", "&lt;").replace("*", "\\*")


def markdown_lines(grid, level):
    """A grid as lines of Markdown, below a heading of the level."""
    width = len(grid.head)
    lines = [f"{'#' * level} {escape_markdown(grid.title)}", "",
             "| " + " | ".join(map(escape_markdown, grid.head)) + " |", "|" + "---|" * width]
    for row in grid.rows:
        mark = "*" if len(row) == 1 else ""
        texts = [f"{mark}{escape_markdown(text)}{mark}" for text in row]
        texts = [f"**{shown}**" if isinstance(text, Best) else shown for text, shown in zip(row, texts)]
        lines.append("| " + " | ".join([*texts, *[""] * (width - len(texts))]) + " |")
    if grid.notes:
        lines += ["", *(f"* {escape_markdown(note)}" for note in grid.notes)]
    return [*lines, ""]


def markdown(report):
    lines = ["# Tables", "", *(f"* {escape_markdown(line)}" for line in preface(report)), ""]
    for level, grid in all_grids(report):
        lines += markdown_lines(grid, level)
    return "\n".join(lines).rstrip() + "\n"


# ---- LaTeX


def escape_latex(text):
    """A text in which LaTeX sees no command. What is no ASCII becomes a question mark, because the
    fonts may lack it."""
    return "".join(SPECIAL.get(c, c if c.isascii() and c.isprintable() else "?") for c in text)


def column_kind(grid, index):
    """Columns are as wide as their texts; long texts are broken into lines."""
    longest = max((len(row[index]) for row in grid.rows if len(row) > index), default=0)
    return r"p{80mm}" if longest > 70 else "l" if index == 0 else "r"


def latex_heading(text):
    """The heading of a column, in short lines."""
    lines = textwrap.wrap(text, 15, break_long_words=False, break_on_hyphens=False)
    broken = r" \\ ".join(map(escape_latex, lines))
    return rf"\begin{{tabular}}[b]{{@{{}}r@{{}}}}{broken}\end{{tabular}}" if lines[1:] else broken


def latex_lines(grid):
    width = len(grid.head)
    kinds = [column_kind(grid, index) for index in range(width)]
    heads = [escape_latex(text) if kind[0] == "p" else latex_heading(text)
             for text, kind in zip(grid.head, kinds)]
    lines = [rf"\begin{{longtable}}{{{''.join(kinds)}}}", rf"\caption{{{escape_latex(grid.title)}}}\\",
             r"\toprule", " & ".join(heads) + r" \\", r"\midrule", r"\endhead", r"\bottomrule",
             r"\endfoot"]
    for index, row in enumerate(grid.rows):
        texts = [rf"\textbf{{{escape_latex(text)}}}" if isinstance(text, Best) else escape_latex(text)
                 for text in row]
        if len(row) == 1:
            lines += [r"\addlinespace"] if index else []
            lines.append(rf"\multicolumn{{{width}}}{{l}}{{\textit{{{texts[0]}}}}} \\")
        else:
            lines.append(" & ".join(texts) + r" \\")
    return [*lines, r"\end{longtable}", *(rf"\noindent {escape_latex(note)}\par" for note in grid.notes), ""]


def latex(report):
    lines = [LATEX_HEAD.rstrip("\n"), *(rf"\noindent {escape_latex(line)}\par" for line in preface(report))]
    for _, grid in all_grids(report):
        if grid.rows:
            lines += ["", *latex_lines(grid)]
    return "\n".join([*lines, r"\end{document}"]) + "\n"
