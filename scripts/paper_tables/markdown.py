# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables as a Markdown file."""

from paper_tables.text import claims_grid, grids, preface, ranking_grid


def escape(text):
    return text.replace("\\", "\\\\").replace("|", "\\|").replace("<", "&lt;").replace("*", "\\*")


def cell_text(item):
    text = escape(item.text)
    return f"**{text}**" if item.is_best else text


def grid_lines(grid, level):
    """A grid as lines of Markdown, below a heading of the level."""
    width = len(grid.head)
    lines = [f"{'#' * level} {escape(grid.title)}", "",
             "| " + " | ".join(escape(text) for text in grid.head) + " |", "|" + "---|" * width]
    for row in grid.rows:
        texts = [cell_text(item) for item in row]
        if len(row) == 1:
            texts = [f"*{texts[0]}*"]
        lines.append("| " + " | ".join([*texts, *[""] * (width - len(texts))]) + " |")
    if grid.notes:
        lines += ["", *(f"* {escape(note)}" for note in grid.notes)]
    return [*lines, ""]


def markdown(report):
    lines = ["# Tables", "", *(f"* {escape(line)}" for line in preface(report)), ""]
    for block in report.blocks:
        for level, grid in enumerate(grids(report, block), 2):
            lines += grid_lines(grid, min(level, 3))
        order = ranking_grid(report, block)
        if order is not None:
            lines += grid_lines(order, 3)
    if report.claims:
        lines += grid_lines(claims_grid(report), 2)
    return "\n".join(lines).rstrip() + "\n"
