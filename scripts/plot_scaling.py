#!/usr/bin/env python3
"""Line plots of a scaling study: STUDY.csv (scripts/scaling.sh) gives STUDY.svg beside it. Standard library only."""
import csv
import math
import os
import sys

WIDTH, HEIGHT = 720, 400
LEFT, RIGHT, TOP, BOTTOM = 64, 24, 44, 52
COLOURS = ("#1f6fb4", "#d1641c", "#3a8f4d")
AXES = {
    "points": "points per sweep",
    "map": "map radius, m",
    "threads": "threads",
    "speed": "speed, m/s",
    "memory": "sweeps so far",
}
TIMES = (("median_ms", "median"), ("p99_ms", "99th percentile"))
MEMORY = (("resident_mb", "resident"), ("peak_mb", "peak"))


def read(path):
    """Columns of a CSV file as lists of numbers; `study` stays text."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    if not rows:
        raise ValueError(f"{path}: no rows below the header")
    study = rows[0]["study"]
    return study, {name: [float(row[name]) for row in rows] for name in rows[0] if name != "study"}


def ticks(top):
    """About five round numbers from 0 up to at least `top`."""
    if not top > 0:
        return [0.0, 1.0]
    rough = top / 5
    unit = 10 ** math.floor(math.log10(rough))
    step = next(unit * factor for factor in (1, 2, 2.5, 5, 10) if unit * factor >= rough)
    return [step * i for i in range(math.ceil(top / step - 1e-9) + 1)]


def text(x, y, content, anchor="middle", extra=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" {extra}>{content}</text>'


def svg(title, x_label, y_label, xs, lines):
    """One plot. `lines`: name and y values; both axes begin at 0."""
    x_ticks, y_ticks = ticks(max(xs)), ticks(max(max(ys) for _, ys in lines))
    across, up = (WIDTH - LEFT - RIGHT) / x_ticks[-1], (HEIGHT - TOP - BOTTOM) / y_ticks[-1]
    bottom = HEIGHT - BOTTOM

    def place(x, y):
        return LEFT + x * across, bottom - y * up

    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" '
        'font-size="12">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
        text(LEFT, 20, title, "start", 'font-size="15"'),
        text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 12, x_label),
        text(LEFT, TOP - 8, y_label, "start"),
    ]
    for y in y_ticks:
        _, at = place(0, y)
        parts.append(f'<path d="M{LEFT} {at:.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>')
        parts.append(text(LEFT - 6, at + 4, f"{y:g}", "end"))
    for x in x_ticks:
        at, _ = place(x, 0)
        parts.append(f'<path d="M{at:.1f} {bottom}v5" stroke="#666"/>')
        parts.append(text(at, bottom + 19, f"{x:,.10g}"))
    for number, (name, ys) in enumerate(lines):
        colour = COLOURS[number % len(COLOURS)]
        points = [place(x, y) for x, y in zip(xs, ys)]
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        parts.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2"/>')
        parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in points]
        parts.append(text(WIDTH - RIGHT - 130 * (len(lines) - 1 - number), 20, name, "end", f'fill="{colour}"'))
    return "\n".join(parts + ["</svg>", ""])


def main(arguments):
    if not arguments or arguments[0].startswith("-"):
        print("usage: plot_scaling.py STUDY.csv…", file=sys.stderr)
        return 2
    for path in arguments:
        study, columns = read(path)
        of_memory = study == "memory"
        lines = [(label, columns[name]) for name, label in (MEMORY if of_memory else TIMES)]
        picture = svg(
            "Memory of the process" if of_memory else "Time of a sweep",
            AXES.get(study, study), "MiB" if of_memory else "ms", columns["value"], lines)
        with open(os.path.splitext(path)[0] + ".svg", "w", encoding="utf-8") as file:
            file.write(picture)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
