// A script that draws the figure again; its data stand in it as one string.
function matplotlibScript(figure) {
  const name = (parts) => Format.mathtext(parts);
  const names = new Map((figure.legend || []).map((one) => [one.series, name(one.name)]));
  const data = {
    x: { title: name(Format.title(figure.x.about)), log: figure.x.log, categories: figure.x.categories || null },
    y: { title: name(Format.title(figure.y.about)), log: figure.y.log, categories: figure.y.categories || null },
    boxes: Object.fromEntries(
      (figure.legend || []).filter((one) => one.kind === 'column').map((one) => [one.series, name(one.name)]),
    ),
    panels: figure.panels.map((panel) => {
      const series = [...new Set(panel.marks.map((mark) => mark.series))].sort((a, b) => a - b),
        jammed = panel.marks.filter((mark) => mark.kind === 'jammed');
      return {
        title: name(panel.title || []),
        series: series.map((place) => {
          const marks = panel.marks
            .filter((mark) => mark.series === place && mark.kind !== 'jammed')
            .sort((a, b) => a.x - b.x);
          return {
            place,
            name: names.get(place) || '',
            x: marks.map((mark) => mark.x),
            y: marks.map((mark) => mark.y),
            half_width: marks.map((mark) => (Format.isNumber(mark.half) ? mark.half : 0)),
            decided: marks.map((mark) => mark.kind === 'decided'),
          };
        }),
        jammed: jammed.map(({ series: place, x, y }) => ({ place, x, y })),
        lines: (panel.lines || []).filter((line) => line.style !== 'guide'),
        bands: panel.bands || [],
        columns: panel.columns || [],
        levels: panel.levels || [],
      };
    }),
  };
  return `#!/usr/bin/env python3
"""Draws a chart of a peclet page again: python3 THIS.py [FILE.pdf]"""
import json
import sys

import matplotlib.pyplot as plt

COLOURS = ["#0072b2", "#c44e00", "#00805c", "#a8487f", "#b07700", "#3a8fc0", "#6b6b00", "#1b1b1b"]
MARKERS = ["o", "s", "D", "^", "v", "P", "H"]
figure = json.loads(${Saving.ascii(Saving.ascii(data))})

panels = figure["panels"]
columns = min(len(panels), 3)
rows = -(-len(panels) // columns)
drawing, axes = plt.subplots(rows, columns, squeeze=False, sharex=True, sharey=True, figsize=(5 * columns, 3.6 * rows))
for axis, panel in zip(axes.flat, panels):
    for band in panel["bands"]:
        x, low, high = zip(*band["places"])
        axis.fill_between(x, low, high, color=COLOURS[band["series"] % 8], alpha=0.16, linewidth=0)
    names = dict(figure["boxes"])
    for column in panel["columns"]:
        width = column["to"] - column["from"]
        height = column["high"] - column["low"]
        colour, name = COLOURS[column["series"] % 8], names.pop(str(column["series"]), None)
        axis.bar(column["from"], height, width, column["low"], align="edge", color=colour, alpha=0.55, label=name)
    for level in panel["levels"]:
        draw = axis.axhline if level["across"] else axis.axvline
        draw(level["value"], color=COLOURS[level.get("series", 0)], linestyle="--", linewidth=1)
    for line in panel["lines"]:
        x, y = zip(*line["places"])
        axis.plot(x, y, color=COLOURS[line["series"] % 8], linestyle="--" if line["style"] == "dashed" else "-")
    for series in panel["series"]:
        colour, marker = COLOURS[series["place"] % 8], MARKERS[series["place"] % 7]
        axis.errorbar(series["x"], series["y"], yerr=series["half_width"], fmt=marker, color=colour, capsize=3,
                      markerfacecolor="white", label=series["name"])
        full = [i for i, decided in enumerate(series["decided"]) if decided]
        axis.plot([series["x"][i] for i in full], [series["y"][i] for i in full], marker, color=colour)
    for jam in panel["jammed"]:  # at its number, or at the edge of the frame where the axis has no place for one
        at, where = jam["y"], axis.transData
        if at is None or figure["y"]["log"] and at <= 0:
            at, where = 1 if at is None else 0, axis.get_xaxis_transform()
        name = "jammed" if jam is panel["jammed"][0] else None
        axis.plot(jam["x"], at, "x", color=COLOURS[jam["place"] % 8], transform=where, clip_on=False, label=name)
    if figure["x"]["log"]:
        axis.set_xscale("log")
    if figure["y"]["log"]:
        axis.set_yscale("log")
    if figure["x"]["categories"]:
        axis.set_xticks(range(len(figure["x"]["categories"])), figure["x"]["categories"])
    axis.set_title(panel["title"], fontsize="medium")
    axis.set_xlabel(figure["x"]["title"])
    axis.set_ylabel(figure["y"]["title"])
    if figure["y"]["categories"]:
        axis.set_yticks(range(len(figure["y"]["categories"])), figure["y"]["categories"])
    if figure["boxes"] or panel["jammed"] or any(series["name"] for series in panel["series"]):
        axis.legend(fontsize="small")
for axis in axes.flat[len(panels):]:
    axis.set_visible(False)
drawing.tight_layout()
if len(sys.argv) > 1:
    drawing.savefig(sys.argv[1])
else:
    plt.show()
`;
}
