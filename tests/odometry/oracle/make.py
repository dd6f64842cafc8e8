#!/usr/bin/env python3
"""The calibration of exact_calibration_test.cpp by NumPy, from the same runs.

    tests/odometry/oracle/make.py

Robust least squares (Huber, 4 sigma) over windows of 2 s, each with a start pose of its own that is
eliminated; the covariance is that of the jackknife over windows. All is written anew from
the comments of include/rift/odometry/calibration.hpp, with differences for derivatives.
"""

import math

import numpy as np

COUNTS_PER_TURN = 358.3
WINDOW_S = 2.0
CONFIDENCE = 0.9
START = {"radius": 0.016, "ratio": 1.0, "track": 0.083}
PRIOR = np.diag(1.0 / np.array([0.5, 0.5, 0.5, 0.1, 0.1, 0.3]) ** 2)
MAD = 1.482602218505602  # of a normal distribution


def student_quantile(q, df):
    """By bisection of Simpson's rule over the density."""
    def share(x):
        at = np.linspace(0.0, x, 20001)
        weight = np.where(np.arange(at.size) % 2, 4.0, 2.0)
        weight[[0, -1]] = 1.0
        scale = math.exp(math.lgamma((df + 1) / 2) - math.lgamma(df / 2)) / math.sqrt(df * math.pi)
        return 0.5 + scale * (weight * (1 + at**2 / df) ** (-(df + 1) / 2)).sum() * at[1] / 3

    low, high = 0.0, 10.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if share(middle) < q else (low, middle)
    return low


def after(pose, step):
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return (pose[0] + c * step[0] - s * step[1], pose[1] + s * step[0] + c * step[1],
            pose[2] + step[2])


def arc(length, turn):
    if abs(turn) < 1e-9:
        return (length, 0.5 * turn * length, turn)
    return (length * math.sin(turn) / turn, length * (1 - math.cos(turn)) / turn, turn)


def wrapped(angle):
    return math.remainder(angle, 2 * math.pi)


def wheels(radius, ratio):
    """Metres of a count, left and right."""
    metres = 2 * math.pi * radius / COUNTS_PER_TURN
    left = 2 / (1 + ratio) * metres
    return left, ratio * left


def winding(phase):
    """(t, left, right) of the encoders and (t, x, y, yaw) of the tag, as Winding() of the test."""
    def counts(t):
        return (150 * t + 40 * math.sin(0.9 * t + phase), 163 * t + 55 * math.cos(0.7 * t + phase))

    encoders = [(0.06 * k, *map(math.floor, counts(0.06 * k))) for k in range(501)]
    left, right = wheels(0.0165, 1.012)
    at, since, last, camera = (0.3, -0.2, 0.4 + phase), 0.0, counts(0.0), []
    for j in range(421):
        t = 0.03 + 0.07 * j
        for i in range(1, 21):
            now = counts(since + (t - since) * i / 20)
            a, b = left * (now[0] - last[0]), right * (now[1] - last[1])
            at, last = after(at, arc(0.5 * (a + b), (b - a) / 0.0862)), now
        since = t
        x, y, yaw = after(at, (0.011, -0.004, 0.05))
        camera.append((t, x + 0.0012 * math.sin(2.4 * j) + (0.05 if j % 23 == 11 else 0.0),
                       y + 0.0009 * math.cos(1.9 * j),
                       yaw + 0.012 * math.sin(2.7 * j) + (0.4 if j % 31 == 7 else 0.0)))
    return encoders, camera


def counts_at(encoders, t):
    times = [row[0] for row in encoders]
    if not times[0] <= t <= times[-1]:
        return None
    return tuple(np.interp(t, times, [row[k] for row in encoders]) for k in (1, 2))


def windows_of(encoders, camera):
    """(rows of the camera, counts rolled before each of them in steps from reading to reading)."""
    poses = [row for row in camera if counts_at(encoders, row[0])]
    while poses:
        rows = [row for row in poses if row[0] < poses[0][0] + WINDOW_S]
        poses = poses[len(rows):]
        rolled = [[]]
        for one, other in zip(rows, rows[1:]):
            points = [counts_at(encoders, one[0])]
            points += [row[1:] for row in encoders if one[0] < row[0] < other[0]]
            points.append(counts_at(encoders, other[0]))
            rolled.append([(b[0] - a[0], b[1] - a[1]) for a, b in zip(points, points[1:])])
        if len(rows) >= 4 and sum(abs(x) + abs(y) for steps in rolled for x, y in steps) > 20:
            yield rows, rolled


def residuals(window, p, start):
    """p: log of the left wheel, the right wheel and the track over their starts, then the tag."""
    left, right = wheels(START["radius"], START["ratio"])
    left, right, track = left * math.exp(p[0]), right * math.exp(p[1]), START["track"] * math.exp(p[2])
    at, found = (0.0, 0.0, 0.0), []
    for row, steps in zip(*window):
        for x, y in steps:
            at = after(at, arc(0.5 * (left * x + right * y), (right * y - left * x) / track))
        seen = after(start, after(at, p[3:]))
        found += [row[1] - seen[0], row[2] - seen[1], wrapped(row[3] - seen[2])]
    return np.array(found)


def slopes(function, at, h=1e-6):
    """Minus the derivative of residuals: that of what is predicted."""
    columns = []
    for k in range(len(at)):
        up, down = np.array(at, float), np.array(at, float)
        up[k] += h
        down[k] -= h
        columns.append((function(down) - function(up)) / (2 * h))
    return np.stack(columns, axis=1)


def normal(window, p, start, noise):
    """Information and score about p with the start pose eliminated, and how the start follows."""
    r = residuals(window, p, start)
    by_p = slopes(lambda q: residuals(window, q, start), p)
    by_start = slopes(lambda s: residuals(window, p, s), start)
    sigma = np.tile([noise[0], noise[0], noise[1]], len(r) // 3)
    weight = np.minimum(1.0, 4.0 / np.maximum(np.abs(r) / sigma, 1e-300)) / sigma**2
    cross = by_start.T @ (by_p * weight[:, None])
    own = by_start.T @ (by_start * weight[:, None])
    follow, shift = np.linalg.solve(own, cross), np.linalg.solve(own, by_start.T @ (weight * r))
    return (by_p.T @ (by_p * weight[:, None]) - cross.T @ follow,
            by_p.T @ (weight * r) - cross.T @ shift, follow, shift)


def fit(windows):
    p, noise = np.zeros(6), (0.002, 0.02)
    starts = [window[0][0][1:] for window in windows]
    for _ in range(200):
        parts = [normal(w, p, s, noise) for w, s in zip(windows, starts)]
        step = np.linalg.solve(PRIOR + sum(n[0] for n in parts), sum(n[1] for n in parts) - PRIOR @ p)
        p = p + step
        moves = [n[3] - n[2] @ step for n in parts]
        starts = [(s[0] + m[0], s[1] + m[1], wrapped(s[2] + m[2])) for s, m in zip(starts, moves)]
        r = np.abs(np.concatenate([residuals(w, p, s) for w, s in zip(windows, starts)])).reshape(-1, 3)
        noise = (MAD * np.median(r[:, :2]), MAD * np.median(r[:, 2]))
        if np.linalg.norm(step) < 1e-11:
            break
    parts = [normal(w, p, s, noise) for w, s in zip(windows, starts)]
    whole = PRIOR + sum(n[0] for n in parts)
    without = [np.linalg.solve(whole - n[0], n[1]) for n in parts]
    n = len(windows)
    return p, noise, sum(np.outer(m, m) for m in without) * (n - 1) / n


def main():
    windows = [w for phase in (0.0, 1.3, 2.9) for w in windows_of(*winding(phase))]
    p, noise, covariance = fit(windows)
    t = student_quantile(0.5 * (1 + CONFIDENCE), len(windows) - len(p))
    left, right = np.array(wheels(START["radius"], START["ratio"])) * np.exp(p[:2])
    metres = 2 * math.pi / COUNTS_PER_TURN
    radius = 0.5 * (left + right) / metres
    by_wheel = np.array([left, right, 0, 0, 0, 0]) / (left + right)
    print("windows", len(windows))
    for name, value, slope in (("wheel_radius_m", radius, by_wheel),
                               ("right_over_left", right / left, np.array([-1, 1, 0, 0, 0, 0])),
                               ("track_m", START["track"] * math.exp(p[2]), np.eye(6)[2])):
        factor = math.exp(t * math.sqrt(slope @ covariance @ slope))
        print(name, value, value / factor, value * factor)
    spread = t * math.sqrt(covariance[3, 3])
    print("tag_ahead_m", p[3], p[3] - spread, p[3] + spread)
    print("noise_m", noise[0], "noise_yaw_rad", noise[1])


if __name__ == "__main__":
    main()
