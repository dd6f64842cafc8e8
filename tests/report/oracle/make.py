#!/usr/bin/env python3
"""Every number of summary.json and explanation.json of an uneven sweep, by NumPy and SciPy.

Reads tests/pinned/report/uneven_table.csv, the trials of Uneven() in tests/report/uneven_sweep.hpp,
and writes values.json (JSON pointers and values) beside itself. Written from the comments of
include/rift/sweep and include/rift/statistics, and shares no code with rift. Run it by hand, only
when a definition or the sweep changes; Debian: python3-numpy, python3-scipy.
"""

import csv
import itertools
import json
import pathlib

import numpy as np
from scipy import optimize, special, stats

HERE = pathlib.Path(__file__).parent
THRESHOLD_M = 0.045
SHARE, CONFIDENCE = 0.2, 0.9  # SweepResult::judged_by
NAN = float("nan")
PARAMETERS = ["v_min", "surface", "delay_s"]
REPEATS, LEAST_GAIN = 3, 0.01  # SuggestOptions


class Trial:
    def __init__(self, number, cells):
        self.id = number
        self.theta = tuple(cells[name] for name in PARAMETERS)
        self.is_ok = cells["status"] == "ok"
        self.falsified = cells["falsified"] == "true"
        self.tells = self.is_ok or self.falsified
        self.repeat = cells["trial"]
        self.of = {k: float(v) for k, v in cells.items() if k.endswith("_m") and v}
        self.u = float(cells["u"] or NAN)
        # The loss: what is judged, or the threshold and the way that was left.
        if self.is_ok:
            self.loss_m = self.of["way_gap_m"]
        elif self.falsified:
            self.loss_m = THRESHOLD_M + self.of["left_m"]

    def level(self, name):
        return self.theta[PARAMETERS.index(name)]


with open(HERE / "../../pinned/report/uneven_table.csv", newline="") as table:
    trials = [Trial(i, cells) for i, cells in enumerate(csv.DictReader(table), 1)]
told = [t for t in trials if t.tells]
levels = {name: sorted({t.level(name) for t in trials}) for name in PARAMETERS}
thetas = list(dict.fromkeys(t.theta for t in trials))
losses = np.array([t.loss_m for t in told])
rows = []


def put(document, pointer, value):
    is_none = value is None or value != value
    rows.append((document, pointer, None if is_none else float(value)))


def mean(values):
    return float(np.mean(values)) if len(values) else None


def interval(values):
    if len(values) < 2:
        return None, None
    return stats.t.interval(0.95, len(values) - 1, np.mean(values), stats.sem(values))


# Alternatives of the evidence about a share: odds over those of the bound, and their weights.
ODDS, WEIGHTS = np.array([2, 3.5, 7, 20, 100]), np.array([0.375, 0.25, 0.125, 0.125, 0.125])


def lower_end(failures, n):
    """The largest bound that the mixture of likelihood ratios excludes (Robbins 1970)."""
    if failures == 0:
        return 0.0
    ratio = lambda b: WEIGHTS @ (ODDS**failures / (1.0 + (ODDS - 1.0) * b) ** n)
    return optimize.brentq(lambda b: np.log(ratio(b) * (1.0 - CONFIDENCE)), 0.0, 1.0, xtol=1e-14)


# summary.json


def put_level(pointer, of):
    gaps = [t.of["gap_m"] for t in of if t.is_ok]
    put("summary", pointer + "/mean_gap_m", mean(gaps))
    put("summary", pointer + "/sd_gap_m", float(np.std(gaps, ddof=1)))
    put("summary", pointer + "/n", len(gaps))
    put("summary", pointer + "/failures", sum(t.falsified for t in of))
    put("summary", pointer + "/told", sum(t.tells for t in of))
    put("summary", pointer + "/not_ok", len(of) - len(gaps))


put_level("", trials)
for key in ("start_offset_m", "start_aligned_gap_m", "shape_gap_m"):
    put("summary", f"/attribution/{key}", mean([t.of[key] for t in trials if t.is_ok]))
for name in PARAMETERS:
    for level in levels[name]:
        put_level(f"/by/{name}/{level}", [t for t in trials if t.level(name) == level])
    groups = [losses[[t.level(name) == level for t in told]] for level in levels[name]]
    f, p = stats.f_oneway(*groups)
    between, within = len(groups) - 1, len(told) - len(groups)
    put("summary", f"/anova/{name}/f", f)
    put("summary", f"/anova/{name}/p", p)
    put("summary", f"/anova/{name}/df/0", between)
    put("summary", f"/anova/{name}/df/1", within)
    put("summary", f"/anova/{name}/eta_squared", f * between / (f * between + within))
    omega = (f - 1.0) * between / (f * between + within + 1.0)
    put("summary", f"/anova/{name}/omega_squared", max(0.0, omega))
for a, b in itertools.product(levels["v_min"], levels["delay_s"]):
    both = [t for t in trials if t.level("v_min") == a and t.level("delay_s") == b]
    put_level(f"/by/[v_min, delay_s]/[{a}, {b}]", both)

failing_settings = 0
for i, theta in enumerate(thetas):
    of = [t for t in told if t.theta == theta]
    failures = sum(t.falsified for t in of)
    failing_settings += failures > 0
    low, high = interval([t.loss_m for t in of])
    at = f"/settings/{i}"
    put("summary", at + "/theta/v_min", float(theta[0]))
    put("summary", at + "/theta/delay_s", float(theta[2]))
    put("summary", at + "/mean_gap_m", mean([t.of["gap_m"] for t in of if t.is_ok]))
    put("summary", at + "/mean_loss_m", mean([t.loss_m for t in of]))
    put("summary", at + "/loss_low_m", low)
    put("summary", at + "/loss_high_m", high)
    put("summary", at + "/failures", failures)
    put("summary", at + "/n", len(of))
    put("summary", at + "/share_low", lower_end(failures, len(of)))
    put("summary", at + "/share_high", 1.0 - lower_end(len(of) - failures, len(of)))
    put("summary", at + "/noise_floor_m", 0.01 + 0.0011 * i)  # set by Uneven()
# Two or three runs decide nothing among twelve settings.
put("summary", "/verdicts/settings_judged_together", len(thetas))
put("summary", "/verdicts/falsified", 0)
put("summary", "/verdicts/passed", 0)
put("summary", "/verdicts/undecided", failing_settings)
put("summary", "/verdicts/not seen to fail", len(thetas) - failing_settings)

# explanation.json: effects


def columns(name):
    """Of one list: all its values but the first, 1 where a trial has it."""
    return [np.array([float(t.level(name) == level) for t in told]) for level in levels[name][1:]]


def model(mains, pairs=()):
    design = [np.ones(len(told))]
    for name in mains:
        design += columns(name)
    for a, b in pairs:
        design += [x * y for x in columns(a) for y in columns(b)]
    return np.column_stack(design)


def error(design):
    solution = np.linalg.lstsq(design, losses, rcond=None)[0]
    return float(np.sum((losses - design @ solution) ** 2))


def predicted(design):
    """Of each trial from all others."""
    squares = 0.0
    for i in range(len(told)):
        rest = np.arange(len(told)) != i
        solution = np.linalg.lstsq(design[rest], losses[rest], rcond=None)[0]
        squares += (losses[i] - design[i] @ solution) ** 2
    return 1.0 - squares / total


total = float(np.sum((losses - losses.mean()) ** 2))
pairs = list(itertools.combinations(PARAMETERS, 2))
plain, crossed = model(PARAMETERS), model(PARAMETERS, pairs)
assert crossed.shape[1] <= len(told) / 2 and predicted(crossed) < predicted(plain)  # so degree 1
residual_df = len(told) - plain.shape[1]
mse = error(plain) / residual_df


def noncentrality(df, f, below):
    """At which a share `below` of the noncentral F, a Poisson mixture of betas, lies below f."""
    x = df * f / (df * f + residual_df)
    j = np.arange(400)

    def cdf(l):
        return stats.poisson.pmf(j, 0.5 * l) @ special.betainc(0.5 * df + j, 0.5 * residual_df, x)

    if stats.f.cdf(f, df, residual_df) <= below:
        return 0.0
    return optimize.brentq(lambda l: cdf(l) - below, 0.0, 300.0, xtol=1e-13, rtol=1e-13)


def share_of(name):
    """df, F and share by omega squared, with its 95 % interval."""
    df = len(columns(name))
    gain = error(model([other for other in PARAMETERS if other != name])) - error(plain)
    f = gain / df / mse
    share = max(0.0, (gain - df * mse) / (total + mse))
    rest = total - gain + df * mse
    low = noncentrality(df, f, 0.975) * mse
    high = noncentrality(df, max(f, 1.0), 0.025) * mse
    return df, f, share, min(share, low / (low + rest)), max(share, high / (high + rest))


shares = {name: share_of(name) for name in PARAMETERS}
# Two with the same share stand in the order of the sweep.
order = sorted(PARAMETERS, key=lambda name: -shares[name][2])
put("explanation", "/effects/trials", len(told))
put("explanation", "/effects/degree", 1)
put("explanation", "/effects/explained", 1.0 - error(plain) / total)
put("explanation", "/effects/predicted", predicted(plain))
put("explanation", "/effects/residual_sd_m", mse**0.5)
for i, name in enumerate(order):
    df, f, share, low, high = shares[name]
    at = f"/effects/parameters/{i}"
    rows.append(("explanation", at + "/parameter", name))
    put("explanation", at + "/share", share)
    put("explanation", at + "/share_interval/0", low)
    put("explanation", at + "/share_interval/1", high)
    put("explanation", at + "/alone", share)  # of degree 1 there is nothing together
    put("explanation", at + "/df/0", df)
    put("explanation", at + "/df/1", residual_df)
    put("explanation", at + "/p", stats.f.sf(f, df, residual_df))


def smallest_detectable(name):
    """Two means d apart, all others in the middle: found with 80 % by the F test at 5 %."""
    counts = [sum(t.level(name) == level for t in told) for level in levels[name]]
    df = len(counts) - 1
    power_at = noncentrality(df, stats.f.isf(0.05, df, residual_df), 0.2)
    return (2.0 * power_at * mse * np.mean([1.0 / n for n in counts])) ** 0.5


for name in PARAMETERS:
    put("explanation", f"/parameters/{name}/p", stats.f.sf(shares[name][1], shares[name][0],
                                                         residual_df))
    put("explanation", f"/parameters/{name}/smallest_detectable_m", smallest_detectable(name))
    # All trials drove paths of their own. A repeat is compared where both values have it.
    rest = {}
    for t in trials:
        others = [t.level(other) for other in PARAMETERS if other != name]
        rest.setdefault((t.repeat, *others), set()).add(t.level(name))
    for i, (a, b) in enumerate(zip(levels[name], levels[name][1:])):
        at = f"/parameters/{name}/identical_paths/{i}"
        put("explanation", at + "/compared", sum({a, b} <= seen for seen in rest.values()))
        put("explanation", at + "/identical", 0)

# explanation.json: what the gaps are made of, over settings


def over_settings(of_trial):
    means = []
    for theta in thetas:
        values = [of_trial(t.of) for t in trials if t.theta == theta and t.is_ok]
        means += [np.mean(values)] if values else []
    return means


def put_estimate(pointer, values):
    low, high = interval(values)
    put("explanation", pointer + "/mean", mean(values))
    put("explanation", pointer + "/low", low)
    put("explanation", pointer + "/high", high)
    put("explanation", pointer + "/n", len(values))


parts = {
    "gap_m": over_settings(lambda of: of["gap_m"]),
    "start_m": over_settings(lambda of: of["gap_m"] - of["start_aligned_gap_m"]),
    "frame_m": over_settings(lambda of: of["start_aligned_gap_m"] - of["shape_gap_m"]),
    "shape_m": over_settings(lambda of: of["shape_gap_m"]),
    "goal_m": over_settings(lambda of: of["gap_m"] - of["way_gap_m"]),
    "noise_m": [0.01 + 0.0011 * i for i in range(len(thetas))],
}
parts["removable_m"] = list(np.subtract(parts["gap_m"], parts["noise_m"]))
# Not in the table: Uneven() sets the distance of Frechet and that at equal times from a count of
# all trials, which is their number in the table.
parts["pace_m"], parts["timing_m"] = [], []
for theta in thetas:
    of = [(t.id, t.of["gap_m"]) for t in trials if t.theta == theta and t.is_ok]
    parts["pace_m"].append(np.mean([gap - (0.7 + 0.003 * n) * gap for n, gap in of]))
    parts["timing_m"].append(np.mean([(1.3 + 0.02 * n) * gap - gap for n, gap in of]))
for key, values in parts.items():
    put_estimate(f"/anatomy/{key}", values)
for i, key in enumerate(("start_m", "frame_m", "shape_m")):
    put_estimate(f"/anatomy/parts/{i}/size_m", parts[key])
put("explanation", "/anatomy/only_at_goal",
    sum(t.is_ok and t.of["gap_m"] > THRESHOLD_M >= t.of["way_gap_m"] for t in trials))

# explanation.json: the kinds of failures, the map of them, and what is undecided

# Uneven() gives trials of the same speed and surface the same path: those are of one kind.
kinds = {}
for t in trials:
    if t.falsified:
        kinds.setdefault(t.theta[:2] if t.is_ok else "fell", []).append(t)
ordered = sorted(kinds.items(), key=lambda kind: (-len(kind[1]), kind[0] == "fell"))
for i, (kind, of) in enumerate(ordered):
    at = f"/failures/{i}"
    put("explanation", at + "/trials", len(of))
    put("explanation", at + "/typical_row", of[0].id)
    put("explanation", at + "/mean_gap_m", mean([t.of["gap_m"] for t in of if t.is_ok]))
    put("explanation", at + "/mean_u", mean([t.u for t in of if t.is_ok]))
    rows.append(("explanation", at + "/status", "fell" if kind == "fell" else "ok"))
    for k, t in enumerate(of):
        put("explanation", f"{at}/rows/{k}", t.id)

for i, (b, a) in enumerate(itertools.product(levels["v_min"], levels["delay_s"])):
    of = [t for t in told if t.level("v_min") == b and t.level("delay_s") == a]
    at = f"/failing_region/cells/{i}"
    rows.append(("explanation", at + "/x", a))
    rows.append(("explanation", at + "/y", b))
    put("explanation", at + "/share", sum(t.falsified for t in of) / len(of))
    put("explanation", at + "/trials", len(of))
i = 0
for theta in thetas:
    of = [t for t in told if t.theta == theta]
    if not any(t.falsified for t in of):
        continue
    at = f"/undecided/{i}"
    i += 1
    put("explanation", at + "/theta/v_min", float(theta[0]))
    put("explanation", at + "/theta/delay_s", float(theta[2]))
    put("explanation", at + "/mean_gap_m", mean([t.of["gap_m"] for t in of if t.is_ok]))
    put("explanation", at + "/failures", sum(t.falsified for t in of))
    put("explanation", at + "/n", len(of))
    for k, t in enumerate(of):
        put("explanation", f"{at}/rows/{k}", t.id)
# No trial was drawn at random.
for key, value in {"share": None, "low": 0.0, "high": 1.0, "confidence": 0.95, "draws": 0,
                   "failures": 0}.items():
    put("explanation", f"/failure_probability/{key}", value)

# explanation.json: the next experiments


def likelihood(failures, n, low, high):
    """Of a share that lies evenly between low and high."""
    share = np.linspace(low, high, 200001)
    return float(np.trapz(stats.binom.pmf(failures, n, share), share) / (high - low))


suggestions = []
for level in levels["v_min"]:  # which a person can set on the robot
    of = [t for t in told if t.level("v_min") == level]
    failures = sum(t.falsified for t in of)
    above, below = likelihood(failures, len(of), SHARE, 1), likelihood(failures, len(of), 0, SHARE)
    fails = above / (above + below)
    wrong = min(fails, 1.0 - fails)
    after = sum(min(fails * likelihood(k, REPEATS, SHARE, 1),
                    (1.0 - fails) * likelihood(k, REPEATS, 0, SHARE)) for k in range(REPEATS + 1))
    if (wrong - after) / REPEATS >= LEAST_GAIN:
        suggestions.append((-(wrong - after), level, of, failures, fails, wrong, after))
for i, (_, level, of, failures, fails, wrong, after) in enumerate(sorted(suggestions)):
    at = f"/suggestions/experiments/{i}"
    put("explanation", at + "/set/v_min", float(level))
    put("explanation", at + "/repeats", REPEATS)
    put("explanation", at + "/failures", failures)
    put("explanation", at + "/mean_loss_m", mean([t.loss_m for t in of]))
    put("explanation", at + "/fails_now", fails)
    put("explanation", at + "/wrong_now", wrong)
    put("explanation", at + "/wrong_after", after)
    for k, t in enumerate(of):
        put("explanation", f"{at}/rows/{k}", t.id)
put("explanation", "/suggestions/trusted", 1.0)  # the trials are the robot's

documents = {"summary": {}, "explanation": {}}
for document, pointer, value in rows:
    documents[document][pointer] = value
(HERE / "values.json").write_text(json.dumps(documents, indent=0) + "\n")
