"""The gap as the paper's analysis scripts compute it, with numpy: the baseline of the benchmarks.

gap_baseline.py SIM REAL            prints the gap of two logs
gap_baseline.py --time SIM REAL     prints the median microseconds of one gap in process
"""
import statistics
import sys
import time

import numpy as np


def load(path):
    columns = open(path).readline().strip().split(",")
    data = np.loadtxt(path, delimiter=",", skiprows=1)
    names = ("t_s", "x_m", "y_m") if "t_s" in columns else ("t", "x", "y")
    t, x, y = (data[:, columns.index(name)] for name in names)
    order = np.argsort(t, kind="stable")
    return x[order], y[order]


def gap(sim, real, samples=2000):
    u = np.linspace(0.0, 1.0, samples)

    def resample(x, y):
        s = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
        s /= s[-1]
        return np.interp(u, s, x), np.interp(u, s, y)

    (sim_x, sim_y), (real_x, real_y) = resample(*sim), resample(*real)
    return np.hypot(sim_x - real_x, sim_y - real_y).max()


def median_us(sim, real):
    times = []
    for _ in range(400):
        begin = time.perf_counter()
        gap(sim, real)
        times.append(1e6 * (time.perf_counter() - begin))
    return statistics.median(times)


if __name__ == "__main__":
    sim_log, real_log = (load(path) for path in sys.argv[-2:])
    print(median_us(sim_log, real_log) if sys.argv[1] == "--time" else gap(sim_log, real_log))
