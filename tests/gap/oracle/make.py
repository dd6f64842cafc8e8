#!/usr/bin/env python3
"""Two unequal, asymmetric logs a case and every field of `rift gap --json`, by definition.

Plain Python, written from the comments of include/rift/gap/comparison.hpp and sharing no code with
rift. Writes CASE_sim.csv, CASE_real.csv and values.csv beside itself; run it only when a definition
changes.
"""

import bisect
import math
import pathlib

HERE = pathlib.Path(__file__).parent
NAN = float("nan")


def wrapped(angle):
    return math.atan2(math.sin(angle), math.cos(angle))


class Path:
    def __init__(self, rows):  # (t, x, y, yaw)
        self.rows = rows
        along = [0.0]
        for a, b in zip(rows, rows[1:]):
            along.append(along[-1] + math.hypot(b[1] - a[1], b[2] - a[2]))
        self.length = along[-1]
        self.u = [s / self.length for s in along]

    def points(self):
        return [(r[1], r[2]) for r in self.rows]

    def edge(self, u):
        """The edge that u is on, the later one at a vertex, and the share of it."""
        i = min(max(bisect.bisect_right(self.u, u) - 1, 0), len(self.rows) - 2)
        span = self.u[i + 1] - self.u[i]
        return i, (u - self.u[i]) / span if span > 0 else 0.0

    def at(self, u):
        i, share = self.edge(u)
        a, b = self.rows[i], self.rows[i + 1]
        return a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])

    def yaw_at(self, u):
        i, share = self.edge(u)
        a, b = self.rows[i][3], self.rows[i + 1][3]
        return a + share * wrapped(b - a)

    def moved(self, x, y, yaw):
        c, s = math.cos(yaw), math.sin(yaw)
        return Path([(t, x + c * px - s * py, y + s * px + c * py, a + yaw)
                     for t, px, py, a in self.rows])


def distance(p, q):
    return math.hypot(p[0] - q[0], p[1] - q[1])


def best_motion(sim, real, n):
    """Least squares: turn by atan2 of the cross and dot sums about the centroids."""
    a = [sim.at(k / (n - 1)) for k in range(n)]
    b = [real.at(k / (n - 1)) for k in range(n)]
    ca = [sum(p[i] for p in a) / n for i in (0, 1)]
    cb = [sum(p[i] for p in b) / n for i in (0, 1)]
    dot = sum((p[0] - ca[0]) * (q[0] - cb[0]) + (p[1] - ca[1]) * (q[1] - cb[1]) for p, q in zip(a, b))
    cross = sum((p[0] - ca[0]) * (q[1] - cb[1]) - (p[1] - ca[1]) * (q[0] - cb[0])
                for p, q in zip(a, b))
    yaw = math.atan2(cross, dot)
    c, s = math.cos(yaw), math.sin(yaw)
    return cb[0] - (c * ca[0] - s * ca[1]), cb[1] - (s * ca[0] + c * ca[1]), yaw


def quantile(values, share):
    values = sorted(values)
    place = share * (len(values) - 1)
    low = int(place)
    return values[low] + (place - low) * (values[min(low + 1, len(values) - 1)] - values[low])


def to_edge(p, a, b):
    dx, dy = b[0] - a[0], b[1] - a[1]
    square = dx * dx + dy * dy
    t = max(0.0, min(1.0, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / square)) if square else 0.0
    return distance(p, (a[0] + t * dx, a[1] + t * dy))


def hausdorff(a, b):
    one_way = lambda f, t: max(min(to_edge(p, x, y) for x, y in zip(t, t[1:])) for p in f)
    return max(one_way(a, b), one_way(b, a))


def frechet(a, b):
    table = [[0.0] * len(b) for _ in a]
    for i, p in enumerate(a):
        for j, q in enumerate(b):
            before = [table[m][n] for m, n in ((i - 1, j - 1), (i - 1, j), (i, j - 1))
                      if m >= 0 and n >= 0]
            table[i][j] = max(distance(p, q), min(before) if before else 0.0)
    return table[-1][-1]


def at_vertices_of_both(sim, real):
    """At every u at which one of them has a vertex, and at 160 even ones where those are fewer."""
    shares = set(sim.u) | set(real.u)
    if len(shares) < 160:
        shares |= {k / 159 for k in range(160)}
    return [[path.at(u) for u in sorted(shares)] for path in (sim, real)]


def warping(a, b):
    table = [[None] * len(b) for _ in a]
    for i, p in enumerate(a):
        for j, q in enumerate(b):
            before = [table[m][n] for m, n in ((i - 1, j - 1), (i - 1, j), (i, j - 1))
                      if m >= 0 and n >= 0]
            total, steps = min(before, key=lambda w: w[0]) if before else (0.0, 0)
            table[i][j] = (total + distance(p, q), steps + 1)
    return table[-1][-1][0] / table[-1][-1][1]


def equal_time(a, b):
    def at(path, since):
        times = [r[0] - path.rows[0][0] for r in path.rows]
        i = min(max(bisect.bisect_right(times, since) - 1, 0), len(times) - 2)
        share = (since - times[i]) / (times[i + 1] - times[i])
        p, q = path.points()[i], path.points()[i + 1]
        return p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])
    end = min(p.rows[-1][0] - p.rows[0][0] for p in (a, b))
    times = [r[0] - p.rows[0][0] for p in (a, b) for r in p.rows]
    return max(distance(at(a, t), at(b, t)) for t in times if t <= end)


def standing(rows, radius):
    """Arc length logged within `radius` of the first point before leaving it, and of the last."""
    near = lambda r, c: math.hypot(r[1] - c[1], r[2] - c[2]) <= radius
    first = 0
    while first + 1 < len(rows) and near(rows[first + 1], rows[0]):
        first += 1
    last = len(rows) - 1
    while last > first and near(rows[last - 1], rows[-1]):
        last -= 1
    step = lambda i: math.hypot(rows[i + 1][1] - rows[i][1], rows[i + 1][2] - rows[i][2])
    return sum(step(i) for i in range(first)) + sum(step(i) for i in range(last, len(rows) - 1))


def compare(sim_rows, real_rows, n, skip, align, radius=0.01):
    sim, real = Path(sim_rows), Path(real_rows)
    if align == "start":
        sim = sim.moved(real.rows[0][1] - sim.rows[0][1], real.rows[0][2] - sim.rows[0][2], 0.0)
    elif align == "se2":
        sim = sim.moved(*best_motion(sim, real, n))
    first = int(skip * n + 1e-9)
    us = [k / (n - 1) for k in range(first, n)]
    error = lambda path, u: distance(path.at(u), real.at(u))
    errors = [error(sim, u) for u in us]
    out = {"gap_m": max(errors), "u": us[errors.index(max(errors))]}
    exact_us = [us[0]] + [u for u in sim.u + real.u if u >= us[0]]
    exact = [(error(sim, u), u) for u in exact_us]
    out["exact_gap_m"], out["exact_u"] = max(exact)
    out["mean_error_m"] = sum(errors) / len(errors)
    out["rms_error_m"] = math.sqrt(sum(e * e for e in errors) / len(errors))
    out["median_error_m"] = quantile(errors, 0.5)
    out["p95_error_m"] = quantile(errors, 0.95)
    yaws = [abs(wrapped(sim.yaw_at(u) - real.yaw_at(u))) for u in us]
    yaws = [y for y in yaws if not math.isnan(y)]
    out["mean_yaw_error_rad"] = sum(yaws) / len(yaws) if yaws else NAN
    out["max_yaw_error_rad"] = max(yaws) if yaws else NAN
    a, b = sim.points(), real.points()
    out["start_offset_m"], out["end_error_m"] = distance(a[0], b[0]), distance(a[-1], b[-1])
    laid = sim.moved(b[0][0] - a[0][0], b[0][1] - a[0][1], 0.0)
    out["start_aligned_gap_m"] = max(error(laid, u) for u in us)
    motion = best_motion(sim, real, n)
    turned = sim.moved(*motion)
    out["shape_gap_m"] = max(error(turned, u) for u in us)
    out["motion_x_m"], out["motion_y_m"], out["motion_yaw_rad"] = motion
    out["sim_length_m"], out["real_length_m"] = sim.length, real.length
    out["length_ratio"] = sim.length / real.length
    out["sim_standstill_share"] = standing(sim_rows, radius) / sim.length
    out["real_standstill_share"] = standing(real_rows, radius) / real.length
    out["hausdorff_m"] = hausdorff(a, b)
    out["frechet_m"] = frechet(*at_vertices_of_both(sim, real))
    even = lambda path: [path.at(k / 159) for k in range(160)]
    out["dtw_m"] = warping(even(sim), even(real))
    out["equal_time_m"] = equal_time(sim, real)
    return out


def log(rows, amplitude, shift, turn, pause, slow, yaw_from=0):
    """A path that no motion and no exchange of axes maps onto the other, at its own pace."""
    out = []
    t = 0.3 + shift
    for i in range(rows):
        s = i / (rows - 1)
        x = 0.9 * s * (2.0 - 0.6 * s) + shift
        y = amplitude * math.sin(4.0 * s) + 0.25 * s ** 3 - 0.4 * shift
        c, r = math.cos(turn), math.sin(turn)
        yaw = math.atan2(4.0 * amplitude * math.cos(4.0 * s) + 0.75 * s * s, 1.8 - 1.08 * s) + turn
        out.append((t, c * x - r * y, r * x + c * y, yaw if i >= yaw_from else NAN))
        t += slow * (1.0 + 0.5 * s)
    still = [(out[0][0] - 0.1 * (pause - k), out[0][1] - 0.001 * (pause - k), out[0][2], out[0][3])
             for k in range(pause)]
    return still + out


CASES = {  # sim, real, samples, skip_start, align
    "plain": (log(37, 0.20, 0.02, 0.03, 0, 0.11), log(53, 0.24, 0.00, 0.0, 4, 0.09), 2000, 0.0, "none"),
    "skipped": (log(41, 0.10, 0.30, 0.0, 3, 0.10), log(29, 0.12, 0.0, 0.1, 0, 0.16), 300, 0.25, "none"),
    "start": (log(33, 0.15, 0.06, -0.2, 0, 0.12), log(47, 0.30, 0.0, 0.0, 2, 0.08), 500, 0.1, "start"),
    "se2": (log(33, 0.15, 0.06, -0.7, 0, 0.12), log(47, 0.30, 0.0, 0.3, 5, 0.08), 101, 0.1, "se2"),
    "unknown_yaw": (log(30, 0.2, 0.0, 2.9, 0, 0.1, 9), log(30, 0.2, 0.0, -3.1, 0, 0.2, 15), 64, 0.0, "none"),
    "few_samples": (log(12, 0.5, 0.01, 0.0, 0, 0.3), log(9, 0.4, 0.0, 0.0, 0, 0.3), 5, 0.0, "none"),
}


def main():
    cell = lambda value: "" if math.isnan(value) else repr(value)
    lines = ["case,samples,skip_start,align,field,value"]
    for case, (sim, real, n, skip, align) in CASES.items():
        for side, rows in (("sim", sim), ("real", real)):
            text = "t_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad,target_x_m,target_y_m\n"
            text += "".join(f"{t!r},{x!r},{y!r},0,0,0,{cell(a)},,\n" for t, x, y, a in rows)
            (HERE / f"{case}_{side}.csv").write_text(text)
        for field, value in compare(sim, real, n, skip, align).items():
            lines.append(f"{case},{n},{skip},{align},{field},{'null' if math.isnan(value) else repr(value)}")
    (HERE / "values.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
