# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables as one HTML page with pictures, which needs no other file and no network."""

import html

import matplotlib.pyplot as plt

from paper_tables import plots
from paper_tables.text import claims_grid, grids, preface, ranking_grid

HEAD = """<!DOCTYPE html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>HullSLAM: tables</title>
<style>
body { font: 15px/1.45 system-ui, sans-serif; margin: 1.5em auto; max-width: 90em; padding: 0 1em;
       color: #1a1a1a; background: #fff; }
table { border-collapse: collapse; margin: .5em 0 1em; font-variant-numeric: tabular-nums; }
th, td { padding: .2em .6em; text-align: right; border-bottom: 1px solid #ddd; white-space: nowrap; }
th { vertical-align: bottom; border-bottom: 1px solid #333; white-space: normal; }
td:first-child, th:first-child, .texts td { text-align: left; white-space: normal; }
tr.group td { font-style: italic; padding-top: .8em; }
td small { display: block; color: #666; }
a { color: #0b5394; text-decoration: none; } a:hover { text-decoration: underline; }
.grid { overflow-x: auto; } svg { max-width: 100%; height: auto; }
nav a { margin-right: 1em; } ul.notes { font-size: 13px; color: #444; }
</style>
<h1>Tables</h1>
"""


def link(text, run):
    text = html.escape(text)
    return f'<a href="{html.escape(plots.link_of(run))}">{text}</a>' if run else text


def cell_html(item):
    text = link(item.text, item.run)
    if item.is_best:
        text = f"<b>{text}</b>"
    if len(item.values) > 1:
        text += "<small>" + " ".join(link(value, run) for value, run in item.values) + "</small>"
    return f"<td>{text}</td>"


def grid_html(grid, level, kind=""):
    width = len(grid.head)
    lines = [f"<h{level}>{html.escape(grid.title)}</h{level}>", f'<div class="grid {kind}"><table>',
             "<tr>" + "".join(f"<th>{html.escape(text)}</th>" for text in grid.head) + "</tr>"]
    for row in grid.rows:
        if len(row) == 1:
            lines.append(f'<tr class="group"><td colspan="{width}">{html.escape(row[0].text)}</td></tr>')
        else:
            lines.append("<tr>" + "".join(cell_html(item) for item in row) + "</tr>")
    lines.append("</table></div>")
    if grid.notes:
        lines.append('<ul class="notes">' + "".join(f"<li>{note_html(note)}</li>"
                                                    for note in grid.notes) + "</ul>")
    return lines


def note_html(note):
    """A note; that of a failed run leads to its folder."""
    mark = "failed: "
    if note.startswith(mark):
        run, _, reason = note.removeprefix(mark).partition(": ")
        return f"{mark}{link(run, run)}: {html.escape(reason)}"
    return html.escape(note)


def has_curves(report, block):
    """Whether the table shows curves of single runs. The first one with an ATE does."""
    first = next((other["table"] for other in report.blocks
                  if "ate" in report.table(other).figures
                  and not report.table(other).degradations), None)
    return block["table"] == first


def shown_runs(report):
    """The names of the runs whose curves are shown."""
    return [run for block in report.blocks if has_curves(report, block)
            for name in block["sequences"] for _, run in plots.median_runs(report, block, name)]


def report_links(report, block, name, out):
    """The reports of the runs whose curves are shown; None if there are none."""
    links = [f'<a href="{html.escape(plots.link_of(run))}out/report.html">{html.escape(label)}</a>'
             for label, run in plots.median_runs(report, block, name)
             if (out / "runs" / run / "out" / "report.html").is_file()]
    return f"<p>Reports of {html.escape(name)}: {', '.join(links)}</p>" if links else None


def pictures(report, block, out):
    """The pictures of a table."""
    if report.table(block).degradations:
        return [plots.level_plot(report, block)]
    names = block["sequences"] if has_curves(report, block) else ()
    return [plots.box_plot(report, block), *(item for name in names for item in (
        plots.curves(report, block, name, out), report_links(report, block, name, out)))]


def block_html(report, block, out):
    first, *others = grids(report, block)
    with plt.rc_context(plots.STYLE):
        shown = [picture for picture in pictures(report, block, out) if picture]
    order = ranking_grid(report, block)
    lines = [line for grid in [*others, *([order] if order else [])] for line in grid_html(grid, 3)]
    return [f'<section id="table-{block["table"]}-{block["mode"]}">', *grid_html(first, 2), *shown, *lines,
            "</section>"]


def page(report, out, comparison):
    """The page. `out` is the folder of the runs, `comparison` a grid or None."""
    lines = [HEAD.rstrip("\n"), "<nav>"]
    lines += [f'<a href="#table-{block["table"]}-{block["mode"]}">{html.escape(report.title(block))}</a>'
              for block in report.blocks]
    lines += ["</nav>", "<ul>", *(f"<li>{html.escape(line)}</li>" for line in preface(report)),
              "<li>Each figure leads to the folder of its run; of several runs, to that with the "
              "median. Small figures are the single runs.</li>", "</ul>"]
    if comparison:
        lines += grid_html(comparison, 2, "texts")
    for block in report.blocks:
        lines += block_html(report, block, out)
    if report.claims:
        lines += grid_html(claims_grid(report), 2, "texts")
    return "\n".join([*lines, "</html>"]) + "\n"
