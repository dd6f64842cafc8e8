#!/usr/bin/env python3
"""Every number of gap::Likeness for three settings of irregular paths, by definition.

Written with NumPy from the comments of include/rift/gap/likeness.hpp and sharing no code with rift;
likeness_drives.csv says what the paths are. Writes likeness.csv beside itself; run it by hand, only
when a definition changes. Debian: python3-numpy.
"""

import csv
import itertools
import math
import pathlib

import numpy as np

from make import Path, distance

HERE = pathlib.Path(__file__).parent
SAMPLES, SKIP_START = 200, 0.1
POINTS, STRIDE, MOVING_MPS, SHORTEST_M = 64, 3, 0.1, 0.06


def drive(rows, takes_s, length_m, left_m, bend, weave_m, waves, phase):
    """Slow at first; weaves about a parabola."""
    out = []
    for i in range(rows):
        s = i / (rows - 1)
        x = length_m * s * (0.4 + 0.6 * s)
        y = left_m + bend * x * x + weave_m * math.sin(2.0 * math.pi * waves * s + phase)
        out.append((takes_s * s, x, y, 0.0))
    return Path(out)


def read_settings():
    """Of each setting the real paths, and the runs: one list for all of them, or one for each."""
    settings = {}
    with open(HERE / "likeness_drives.csv", newline="") as table:
        for cells in csv.DictReader(table):
            lists = settings.setdefault(cells.pop("setting"), {})
            place = lists.setdefault(cells.pop("list"), [])
            place.append(drive(int(cells.pop("rows")), **{k: float(v) for k, v in cells.items()}))
    return [(lists.pop("real"), list(lists.values())) for lists in settings.values()]


SETTINGS = read_settings()


def gap(a, b):
    us = [k / (SAMPLES - 1) for k in range(int(SKIP_START * SAMPLES + 1e-9), SAMPLES)]
    return max(distance(a.at(u), b.at(u)) for u in us)


def shape(path):
    return np.array([path.at(k / (POINTS - 1)) for k in range(POINTS)])


def apart(a, b):
    return float(np.mean(np.linalg.norm(a - b, axis=1)))


def across(path):
    """Distance from the straight line that fits best: the second principal component."""
    points = shape(path) - shape(path).mean(axis=0)
    return points @ np.linalg.svd(points)[2][1]


def weave(path):
    return float(np.sqrt(np.mean(across(path) ** 2)))


def speed(path):
    rows = path.rows
    speeds = [distance(a[1:3], b[1:3]) / (b[0] - a[0]) for a, b in zip(rows, rows[STRIDE:])]
    return float(np.median([v for v in speeds if v > MOVING_MPS]))


def wavelength(paths):
    """The one of sixty, evenly by their logarithms, with the largest power over all paths."""
    waves = np.geomspace(SHORTEST_M, max(path.length for path in paths), 60)
    u = np.linspace(0.0, 1.0, POINTS)
    power = [sum(abs(across(path) @ np.exp(-2j * np.pi * u * path.length / wave)) ** 2
                 for path in paths) for wave in waves]
    return float(waves[int(np.argmax(power))])


def runs_of(setting, real):
    reals, lists = setting
    return lists[real] if len(lists) == len(reals) else lists[0]


def repeats(paths):
    return [gap(a, b) for a, b in itertools.combinations(paths, 2)]


def spread(setting):
    """(simulated, real): mean gap between repeats; run i of one real path and of the other."""
    reals, lists = setting
    if len(lists) == 1:
        simulated = repeats(lists[0])
    else:
        simulated = [gap(x, y) for a, b in itertools.combinations(lists, 2) for x, y in zip(a, b)]
    return [[np.mean(gaps)] if gaps else [] for gaps in (simulated, repeats(reals))]


def traits(setting, of):
    reals, lists = setting
    return [[of(path) for one in lists for path in one], [of(path) for path in reals]]


def energy(distances, reals):
    sims = [i for i in range(len(distances)) if i not in reals]
    mean = lambda a, b: distances[np.ix_(a, b)].mean()
    return 2.0 * mean(reals, sims) - mean(reals, reals) - mean(sims, sims)


def main():
    out = {"reals": sum(len(s[0]) for s in SETTINGS),
           "sims": sum(len(one) for s in SETTINGS for one in s[1])}
    for name, per_setting in {"spread_m": [spread(s) for s in SETTINGS],
                              "weave_m": [traits(s, weave) for s in SETTINGS],
                              "speed_mps": [traits(s, speed) for s in SETTINGS]}.items():
        mean = lambda chosen, side: np.mean(sum((per_setting[i][side] for i in chosen), []))
        every = range(len(SETTINGS))
        out[name + "/sim"], out[name + "/real"] = mean(every, 0), mean(every, 1)
        # Of three settings a 95 % interval by Student's t holds all that can be drawn.
        ratios = [mean(drawn, 0) / mean(drawn, 1) for drawn in itertools.product(every, repeat=3)
                  if any(per_setting[i][1] for i in drawn)]
        out[name + "/low"], out[name + "/high"] = min(ratios), max(ratios)
    out["wavelength_m/sim"] = wavelength([p for s in SETTINGS for one in s[1] for p in one])
    out["wavelength_m/real"] = wavelength([p for s in SETTINGS for p in s[0]])

    gaps, mean_gaps, inside, expected = [], [], [], []
    groups = []  # of a shuffle: which stand together, and how many of them are real
    paths, reals = [], []
    for setting in SETTINGS:
        for i, real in enumerate(setting[0]):
            runs = runs_of(setting, i)
            gaps += [gap(run, real) for run in runs]
            shapes = [shape(run) for run in runs]
            middle = np.mean(shapes, axis=0)
            mean_gaps.append(gap(Path([(k, x, y, 0.0) for k, (x, y) in enumerate(middle)]), real))
            band = max(apart(one, np.mean([o for o in shapes if o is not one], axis=0))
                       for one in shapes)
            inside.append(apart(shape(real), middle) <= band)
            expected.append(len(runs) / (len(runs) + 1))
        is_matched = len(setting[0]) == len(setting[1])
        for some in [[r] for r in setting[0]] if is_matched else [setting[0]]:
            runs = runs_of(setting, setting[0].index(some[0]))
            first = len(paths)
            paths += [*some, *runs]
            reals += range(first, first + len(some))
            groups.append((range(first, len(paths)), len(some)))
    out["mean_gap_m"], out["mean_path_gap_m"] = np.mean(gaps), np.mean(mean_gaps)
    out["inside_share"], out["inside_expected"] = np.mean(inside), np.mean(expected)
    shapes = [shape(path) for path in paths]
    distances = np.array([[apart(a, b) for b in shapes] for a in shapes])
    out["energy_m"] = energy(distances, reals)
    shuffles = [energy(distances, sum(map(list, drawn), [])) for drawn in
                itertools.product(*(itertools.combinations(*group) for group in groups))]
    out["energy_p"] = np.mean(np.array(shuffles) >= out["energy_m"] - 1e-12)  # of all there are
    text = "".join(f"{field},{float(value)!r}\n" for field, value in out.items())
    (HERE / "likeness.csv").write_text("field,value\n" + text)


if __name__ == "__main__":
    main()
